// Pictures without a display: MuJoCo's renderer in an OpenGL context of EGL's surfaceless platform,
// which Mesa offers with or without a graphics card.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mujoco_ref/skin_model.hpp"

namespace hagfish {

/// 8-bit RGB, rows from the top.
struct Image {
  int width = 0, height = 0;       ///< px
  std::vector<unsigned char> rgb;  ///< 3 x width x height
};

/// Writes `image` to `file` as PNG, replacing it. Throws FileError.
void write_png(const Image& image, const std::filesystem::path& file);

/// A window of the picture plane, which is seen through so long a lens that parallel lines stay
/// parallel: the scale is exact in the middle of the depth of what is shown, and right to 1 % as
/// far from there as half the model's extent.
struct View {
  Eigen::Vector3d right, up;                      ///< world, unit, at right angles
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< lower left corner along right and up, cm
  int width = 0, height = 0;                      ///< px
  double scale = 0;                               ///< px/cm

  Eigen::Vector3d toward() const { return right.cross(up); }  ///< way from the scene to the viewer
};

/// What a picture costs: with the software renderer most of it goes to shadows.
struct PictureQuality {
  int shadows = 3;         ///< lights with a shadow, in a ring so that theirs overlap to a soft one
  int shadow_size = 4096;  ///< size of their shadow maps, px
};

/// What the colours of a skin stand for: drawn as a bar in the lower right corner.
struct ColourBar {
  std::vector<std::array<unsigned char, 3>> colour;  ///< colours from least value to largest
  std::string title, least, most;                    ///< words above it, and below its ends
};
/// Height of the lower edge of a picture that a bar and its words take, px.
inline constexpr int bar_room = 76;
/// Length of the scale bar of a picture, cm: 1, 2 or 5 times a power of ten, a sixth of the
/// picture's width at most.
double scale_bar(const View& view);

/// One OpenGL context for any number of pictures. Keep one at a time, in the thread that made it.
class OffscreenRenderer {
 public:
  /// Makes pictures of at most `width` x `height` px (8192 either way) of things about as large as
  /// `model`. Its own settings for pictures are not used. Throws std::runtime_error beyond that
  /// size, and InputError where this machine has no OpenGL for it: one line with the step that
  /// failed and EGL's or MuJoCo's reason.
  OffscreenRenderer(const mjModel& model, int width, int height,
                    const PictureQuality& quality = {});
  ~OffscreenRenderer();

  /// Draws `geoms` (mjv_initGeom, cm) before white, with shadows. Throws std::runtime_error where
  /// the view is larger than what the renderer was made for.
  Image render(const std::vector<mjvGeom>& geoms, const View& view);
  /// Draws these and a skin. It has as many points as skin_model() made the renderer's model for
  /// (else std::invalid_argument). A line of text, unless it is empty, comes in the lower left
  /// corner, with a scale bar above it; and the colour bar, if any.
  Image render(const std::vector<mjvGeom>& geoms, const View& view, const Skin& skin,
               const std::string& words = "", const ColourBar* bar = nullptr);

 private:
  struct Parts;
  Image draw(const std::vector<mjvGeom>& geoms, const View& view, const Skin* skin,
             const std::string& words, const ColourBar* bar);
  std::unique_ptr<Parts> parts_;
};

}  // namespace hagfish
