// Fixed things that the skin of the animal stays out of. They do not move, deform or rub.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

namespace hagfish {

/// A plane with the half space behind it: each body, as a sphere about its centre, stays on the
/// side that `normal` points to.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< a point in it, world, cm
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, world
  double neck = 0;  ///< bodies nearer the head than this pass through, cm of arc
};

/// The tube about a curve with round ends: a Catmull-Rom spline, as the body's.
struct Strand {
  std::vector<Eigen::Vector3d> points;  ///< points of the curve, world, cm; a single one is a ball
  double radius = 0;                    ///< radius of the tube, cm
  bool closed = false;                  ///< the curve goes on from its last point to its first
};

struct Obstacle {
  std::string name;
  std::variant<Strand, Plane> shape;

  /// Null where it is something else.
  const Plane* plane() const { return std::get_if<Plane>(&shape); }
  const Strand* strand() const { return std::get_if<Strand>(&shape); }
};

}  // namespace hagfish
