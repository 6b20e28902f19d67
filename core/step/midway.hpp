// Where the equations of a step hold, and the motion that it starts with there: at its start
// (Euler's rule), or in its middle (the midpoint rule, core/README.md, "Steps in time").
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/contact/spline.hpp"

namespace hagfish {

/// The middle of a step, as far as it is known.
struct Midway {
  Eigen::VectorXd moved, felt;          ///< velocities by which the step moves, and on the mean, nv
  Eigen::VectorXd q;                    ///< where `moved` leads in half a step, nq
  Kinematics kin;                       ///< at q, of `moved` and `felt`
  std::vector<SplineSegment> segments;  ///< at q
  Matrix6Xd twist;                      ///< of the bodies at the step's first velocity, 6 x N
  Eigen::Matrix3Xd centre_velocity;     ///< of their centres at it, 3 x N, cm/s
  Matrix6Xd felt_twist;                 ///< at `felt`, 6 x N
};

/// Places the middle of a step of `h` (s) from `state` by midway.moved and midway.felt.
void place_midway(const Model& model, const State& state, double h, Midway& midway);

}  // namespace hagfish
