// How far the core and MuJoCo are apart in one state: kinematics, inertia, forces, acceleration.
#pragma once

#include <Eigen/Core>
#include <random>

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// Largest differences, each over its scale. Velocities of cm/s and rad/s compare once each is
/// multiplied by sqrt(M_ii), forces once divided by it: then M has unit diagonal.
struct Agreement {
  double position = 0;      ///< body frames and centres, over the length of the chain
  double orientation = 0;   ///< entries of the rotation matrices
  double mass = 0;          ///< |ΔM_ij| / sqrt(M_ii M_jj)
  double bias = 0;          ///< Coriolis, gyroscopic, gravity, spring and damper forces, over the
                            ///< largest of them
  double acceleration = 0;  ///< q̈ without contacts, limits and drag, over its largest entry
  double condition = 1;     ///< condition of M with unit diagonal: rounding grows so in q̈
};

/// What must be met, by rounding: a chain of 100 bodies multiplies as many rotations, bias sums
/// terms that cancel, and q̈ has the condition of M besides.
inline constexpr Agreement agreement_bound{1e-12, 1e-12, 1e-11, 1e-10, 1e-9};

/// Bound of the acceleration in states in which M has that condition, at most: agreement_bound's,
/// but that unlike masses condition M worse than any chain of the animal's.
double acceleration_bound(double condition);

/// Compares in one state; of `mirror` the constraints are switched off. With a clamped head the
/// core's q̈ comes from Eq. 3, its six multipliers included, MuJoCo's from a chain without a root;
/// root entries are left out.
Agreement agreement(const Model& model, const State& state, MujocoModel& mirror);

/// The worst of both, entry by entry.
Agreement worst(const Agreement& a, const Agreement& b);

/// A free head anywhere within a body's length of the origin and turned in any way; a clamped one
/// at rest. Hinge angles even over ±angle (rad) whatever their limits, velocities over ±spin
/// (cm/s, rad/s). The same on every platform.
State drawn_state(std::mt19937& random, const Model& model, Head head, double angle, double spin);

}  // namespace hagfish
