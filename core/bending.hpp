// The total bend of a universal joint, which turns by y about Y, then by z about Z: the angle
// between the X axes of its two bodies, and the limit on it, a cone.
#pragma once

#include <Eigen/Core>

#include "core/model.hpp"

namespace hagfish {

struct Bend {
  double angle = 0;       ///< θ, rad, 0 to pi
  Eigen::Vector2d slope;  ///< dθ/dy, dθ/dz; 0 where the joint is straight: θ has no slope there
};

/// cos θ = cos y cos z, to rounding at any θ.
Bend total_bend(double y, double z);

/// Angles y, z of the bend by `angle` (rad, below pi/2) in the same plane as that by `y`, `z` (not
/// straight).
Eigen::Vector2d bend_in_plane(double y, double z, double angle);

/// How far a joint is bent past its cone at coordinates `q` (nq), rad; 0 within it.
double past_cone(const BendingCone& cone, const Eigen::VectorXd& q);

}  // namespace hagfish
