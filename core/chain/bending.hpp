// The total bend of a universal joint: the angle between the X axes of its two bodies, and the
// limit on it, a cone. The joint turns by y about Y, then by z about Z. In a joint that turns about
// Z first (make_hagfish), y stands for the first angle and z for the second.
#pragma once

#include <Eigen/Core>

#include "core/chain/model.hpp"

namespace hagfish {

/// Whether a body's joint bends (the others twist, or belong to the root).
inline bool bends(const Body& body) { return body.dofs == 2; }

struct Bend {
  double angle = 0;  ///< θ, rad, 0 to pi
  /// dθ/dy, dθ/dz; 0 where the joint is straight: θ has no slope there.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

/// cos θ = cos y cos z, to rounding at any θ.
Bend total_bend(double y, double z);

/// Angles y, z of the bend by `angle` (rad, below pi/2) in the direction of `y`, `z` (not
/// straight): these are scaled down together until neither is past `angle`, then brought to it in
/// their plane.
Eigen::Vector2d bend_to(double y, double z, double angle);

/// How far a joint is bent past its cone at coordinates `q` (nq), rad; 0 within it. A hinge past 90
/// degrees counts by itself: with both there, the axes come together again.
double past_cone(const BendingCone& cone, const Eigen::VectorXd& q);

}  // namespace hagfish
