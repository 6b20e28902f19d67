// The middle of a midpoint-rule step (core/README.md, "Steps in time").
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/contact/spline.hpp"

namespace hagfish {

/// The middle of a step, as far as it is known.
struct Midway {
  Eigen::VectorXd step_velocity;        ///< velocity by which the step moves, nv
  Eigen::VectorXd mean_velocity;        ///< mean of those before and after the step, nv
  Eigen::VectorXd q;                    ///< coordinates after half a step by the step velocity, nq
  Kinematics kin;                       ///< pose q and its motion by both velocities
  std::vector<SplineSegment> segments;  ///< segments at q
  Matrix6Xd twist;                      ///< bodies' twists at the step's first velocity, 6 x N
  Eigen::Matrix3Xd centre_velocity;     ///< velocities of their centres at it, 3 x N, cm/s
  Matrix6Xd mean_twist;                 ///< bodies' twists at the mean velocity, 6 x N
  BiasPower bias_power;                 ///< powers of the bias, if `balanced`
  bool balanced = false;                ///< whether Coriolis forces make no energy
  State next;                           ///< state after the whole step by the two velocities
  Eigen::VectorXd next_energy;          ///< kinetic energy of each body there, erg, N

  StepMotion motion() const {
    return {twist, centre_velocity, mean_twist, balanced ? &bias_power : nullptr};
  }
};

/// Places the middle of a step of `h` (s) from `state` by both of its velocities; `now` belongs to
/// `state`. `balanced` decides whether the bias is balanced, so that Coriolis forces make no
/// energy: where momentum is `kept` for one who falls freely beside the body, with the velocity of
/// its centre of mass at first, else for one who stands.
void place_midway(const Model& model, const State& state, const Kinematics& now, double h,
                  bool balanced, bool kept, Midway& midway);

}  // namespace hagfish
