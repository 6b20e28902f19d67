// Where the equations of a step hold, and the motion that it starts with there: at its start
// (Euler's rule), or in its middle (the midpoint rule, core/README.md, "Steps in time").
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/contact/spline.hpp"

namespace hagfish {

/// The middle of a step, as far as it is known.
struct Midway {
  Eigen::VectorXd q;  ///< nq
  /// At q; at the velocity by which the step is expected to move, which its bias is of.
  Kinematics kin;
  std::vector<SplineSegment> segments;  ///< at q
  Matrix6Xd twist;                      ///< of the bodies at the step's first velocity, 6 x N
  Eigen::Matrix3Xd centre_velocity;     ///< of their centres at it, 3 x N, cm/s
};

/// The middle of a step of `h` (s) from `state` that moves by the velocity `moved` (nv).
void place_midway(const Model& model, const State& state, const Eigen::VectorXd& moved, double h,
                  Midway& midway);

}  // namespace hagfish
