// Fixed things that the skin of the animal stays out of.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hagfish {

/// A plane with the half space behind it, or a strand. Obstacles do not move, deform or rub.
struct Obstacle {
  enum class Kind { plane, strand };
  std::string name;
  Kind kind = Kind::strand;
  // A plane keeps each body, as a sphere about its centre, on the side that `normal` points to.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< of the plane, world, cm
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, world
  double neck = 0;  ///< bodies nearer the head than this pass through, cm of arc
  // A strand is the tube about a curve with round ends: a Catmull-Rom spline, as the body's.
  std::vector<Eigen::Vector3d> points;  ///< that the curve goes through, world, cm; one is a ball
  double radius = 0;                    ///< of the tube, cm
  bool closed = false;                  ///< the curve goes on from its last point to its first
};

}  // namespace hagfish
