// Frames of a log as pictures, one after another from one renderer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/export/body_quantity.hpp"
#include "experiments/mujoco/picture.hpp"

namespace hagfish {

/// Width and height, px.
struct PictureSize {
  int width = 0, height = 0;
};

/// "1280x720". Throws InputError, naming `option`, for anything else and beyond 16 to 8192 px.
PictureSize picture_size(const std::string& text, const std::string& option);

/// The frame whose time is nearest. Throws InputError outside the log.
std::size_t frame_at(const LogContents& log, double time);

/// What is to be seen of the frames of a log, which is referred to.
class FramePictures {
 public:
  /// Coloured by a quantity of the body where it is not empty (body_quantity.hpp). Throws
  /// InputError for angles (degrees, as turned_view) that are no numbers.
  FramePictures(const LogContents& log, double pitch, double yaw, const std::string& quantity = "");

  /// Adds a frame to what the window must show.
  void add(std::size_t frame, Shown& shown) const;
  /// The view, its window not set.
  const View& view() const { return view_; }
  /// A renderer for windows up to this size.
  std::unique_ptr<OffscreenRenderer> renderer(PictureSize size,
                                              const PictureQuality& quality) const;
  Image draw(OffscreenRenderer& renderer, std::size_t frame, const View& view,
             const std::string& words = "") const;
  /// The window of what is shown and little more, of 80 px/cm; or `size`, at the scale at which it
  /// fits. With room for the colour bar, where there is one, and for `words` and their scale bar.
  void fit(const Shown& shown, std::optional<PictureSize> size, View& view,
           bool words = false) const;

 private:
  Skin skin(std::size_t frame) const;
  /// Floors and walls fill the window, and do not widen it.
  std::vector<mjvGeom> obstacles(std::size_t frame, bool floors) const;

  const LogContents& log_;
  View view_;
  std::optional<BodyQuantity> quantity_;
  double scale_ = 0;
  std::optional<ColourBar> bar_;
  MujocoModel model_;
};

}  // namespace hagfish
