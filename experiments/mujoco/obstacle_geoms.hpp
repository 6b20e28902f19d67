// What stands about the animal in a picture, as MuJoCo's renderer takes it.
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "core/scene/obstacle.hpp"

namespace hagfish {

/// The head plate behind the plane x = 0; pale where it does not hold the head.
mjvGeom plate_geom(bool holds_head);

/// What `obstacle`, one of `obstacles`, looks like about an animal of `length` (cm): a square of a
/// plane with the hole that its rim closes about, or a tube. A ring about no hole is cut open
/// towards the viewer, who is in direction `toward` (world), so that what is in it is seen.
std::vector<mjvGeom> obstacle_geoms(const Obstacle& obstacle,
                                    const std::vector<Obstacle>& obstacles, double length,
                                    const Eigen::Vector3d& toward);

}  // namespace hagfish
