// What a picture of one frame of a log shows: the animal's skin, as MuJoCo's renderer takes it, and
// through which window.
#pragma once

#include <array>
#include <vector>

#include "core/chain/model.hpp"
#include "core/scene/specimen.hpp"
#include "mujoco_ref/offscreen.hpp"

namespace hagfish {

/// Rings of the animal's skin and points of each.
int skin_rings(const Model& model);
inline constexpr int skin_sides = 28;

/// The skin that self-contact knows (core/contact/contact.cpp), the sphere that sweeps along the
/// spline through the body centres, with round ends; dark rings where the specimen was measured
/// (Specimen::station). `centre` is 3 x N, cm, world; the rings run head to tail.
Skin skin_of(const Model& model, const Specimen& specimen, const Eigen::Matrix3Xd& centre);

/// Colours the skin by `value` at stations `arc` (cm from the head, rising, at least one), linear
/// in between, from 0 to `scale`; the dark rings stay.
void paint(const Model& model, const Specimen& specimen, const std::vector<double>& arc,
           const Eigen::VectorXd& value, double scale, Skin& skin);

/// The colours of paint() from 0 to its scale, even.
std::vector<std::array<unsigned char, 3>> colour_steps();

/// Degrees, where nothing else is asked for.
inline constexpr double usual_pitch = -70, usual_yaw = 22;

/// Looks along -Z with +X to the right, then turned about X by `pitch` and about the picture's
/// vertical by `yaw` (degrees). Its window is yet to be set.
View turned_view(double pitch, double yaw);

/// What is seen in the picture plane, cm.
struct Shown {
  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY);
  Eigen::Array2d high = Eigen::Array2d::Constant(-INFINITY);
  void add(const View& view, const Skin& skin);
  void add(const View& view, const mjvGeom& box);
};

/// Sets the window to what is shown and little more, at 80 px/cm.
void fit(const Shown& shown, View& view);
/// Adds `room` px below, for what is written there.
void add_room(int room, View& view);
/// Sets it to `width` x `height` px, at the scale at which what is shown just fits, in the middle.
void fit(const Shown& shown, int width, int height, View& view);

}  // namespace hagfish
