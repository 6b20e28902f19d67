// What stands about the animal in a picture, as MuJoCo's renderer takes it.
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "experiments/view/drawn_obstacles.hpp"

namespace hagfish {

/// The head plate behind the plane x = 0; pale where it does not hold the head.
mjvGeom plate_geom(bool holds_head);

/// An obstacle. A ring is cut open towards the viewer, who is in direction `toward` (world), so
/// that what is in it is seen.
std::vector<mjvGeom> obstacle_geoms(const DrawnObstacle& obstacle, const Eigen::Vector3d& toward);

}  // namespace hagfish
