// What a picture of one frame of a log shows: the animal's skin and the head plate, as MuJoCo's
// renderer takes them.
#pragma once

#include <vector>

#include "core/chain/model.hpp"
#include "core/scene/specimen.hpp"
#include "mujoco_ref/offscreen.hpp"

namespace hagfish {

/// The skin that self-contact knows (core/contact/contact.cpp), the sphere that sweeps along the
/// spline through the body centres, as spheres so close that none is seen; dark rings where the
/// specimen was measured (Specimen::station). `centre` is 3 x N, cm, world; the geoms run head to
/// tail.
std::vector<mjvGeom> skin_geoms(const Model& model, const Specimen& specimen,
                                const Eigen::Matrix3Xd& centre);

/// The head plate behind the plane x = 0; pale where it does not hold the head.
mjvGeom plate_geom(bool holds_head);

/// Looks along -Z with +X to the right, then turned about X by `pitch` and about the picture's
/// vertical by `yaw` (degrees). The window holds spheres and boxes among `geoms`, and little more.
View view_of(const std::vector<mjvGeom>& geoms, double pitch, double yaw);

}  // namespace hagfish
