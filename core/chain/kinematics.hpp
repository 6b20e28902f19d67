// Positions and motions of the bodies, from q and q̇: once per step, used by all that follows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/chain/model.hpp"
#include "core/chain/spatial.hpp"
#include "core/chain/state.hpp"

namespace hagfish {

/// How all bodies move at one velocity of the chain.
struct BodyVelocities {
  const Matrix6Xd& twist;          ///< twists about O, 6 x N
  const Eigen::Matrix3Xd& centre;  ///< velocities of their centres, 3 x N, cm/s
};

/// World axes. Spatial vectors are about `reference`, the centre of the middle body: taken about
/// the far head, a 100-body solve loses two digits.
struct Kinematics {
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< O, cm
  std::vector<Eigen::Matrix3d> rotation;                ///< N, body to world
  Eigen::Matrix3Xd origin;                              ///< 3 x N, body frames, cm
  Eigen::Matrix3Xd centre;                              ///< 3 x N, centres of mass, cm
  Eigen::VectorXd sine, cosine;                         ///< sines and cosines of the hinges' angles
  Matrix6Xd axis;   ///< 6 x nv: column k of the Jacobian of every body at or behind dof k
  Matrix6Xd twist;  ///< 6 x N, body twists at q̇
  Eigen::Matrix3Xd centre_velocity;  ///< velocities of the centres of mass at q̇, 3 x N, cm/s
  Matrix6Xd bias_twist;              ///< 6 x N, J̇ q̇: rates of the twists at q̈ = 0

  Eigen::Vector3d centre_offset(int body) const { return centre.col(body) - reference; }
  BodyVelocities velocities() const { return {twist, centre_velocity}; }  ///< motion at q̇
};

/// What the bodies' bias is to work over a step, so that Coriolis forces neither make nor take
/// energy (core/README.md, "Steps in time").
struct BiasPower {
  Eigen::VectorXd value;  ///< power of each body, erg/s, N
  /// A body's momentum over its motion counts as no less, erg: what hardly moves would need forces
  /// far larger than its own.
  double least = 0;
  /// Mean velocity of the observer who sees this power, cm/s, world.
  Eigen::Vector3d observer = Eigen::Vector3d::Zero();
};

/// What Eq. 1 needs to know of the motion at the place of its step.
struct StepMotion {
  const Matrix6Xd& twist;                   ///< bodies' twists at the step's first velocity, 6 x N
  const Eigen::Matrix3Xd& centre_velocity;  ///< velocities of their centres at it, 3 x N, cm/s
  const Matrix6Xd& mean_twist;              ///< bodies' twists at the mean velocity, 6 x N
  const BiasPower* bias_power = nullptr;    ///< null where the bias works what it does

  /// Motion at the step's first velocity.
  BodyVelocities before() const { return {twist, centre_velocity}; }
};

/// The motion of a step whose equations hold at its start.
inline StepMotion motion_of(const Kinematics& kin) {
  return {kin.twist, kin.centre_velocity, kin.twist};
}

/// Positions and axes; does not touch the velocity fields.
void update_positions(const Model& model, const Eigen::VectorXd& q, Kinematics& kin);

/// Positions and axes with the centre of mass at `centre` (cm, world); puts the root into `q`.
void place_centre(const Model& model, const Eigen::Vector3d& centre, Eigen::VectorXd& q,
                  Kinematics& kin);

/// Centre of mass of all bodies, cm, world.
Eigen::Vector3d centre_of_mass(const Model& model, const Kinematics& kin);

/// The mean of the columns of `of` (3 x N), one for each body, by their masses.
Eigen::Vector3d mean_by_mass(const Model& model, const Eigen::Matrix3Xd& of);

/// Twists and bias twists; after update_positions.
void update_velocities(const Model& model, const Eigen::VectorXd& qdot, Kinematics& kin);
/// Twists and bias twists where bodies move by `step_velocity`, but have the velocities
/// `mean_velocity` (nv both) on the mean while they do (midpoint rule): bias_twist is the rate of J
/// along `step_velocity`, times `mean_velocity`; the rest is of `step_velocity`.
void update_velocities(const Model& model, const Eigen::VectorXd& step_velocity,
                       const Eigen::VectorXd& mean_velocity, Kinematics& kin);

Kinematics kinematics(const Model& model, const State& state);

// Functions with an output argument write into its storage.

/// Twists of all bodies (6 x N) at the velocities `v` (nv) instead of q̇.
Matrix6Xd body_twists(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v);
void body_twists(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v,
                 Matrix6Xd& twist);

/// Velocities of the bodies' centres (3 x N, cm/s) at `twist` (6 x N).
Eigen::Matrix3Xd centre_velocities(const Kinematics& kin, const Matrix6Xd& twist);
void centre_velocities(const Kinematics& kin, const Matrix6Xd& twist, Eigen::Matrix3Xd& velocity);

/// J' w: generalised force (nv) of one wrench about O per body (6 x N). Exactly zero at every dof
/// that has no loaded body behind it.
Eigen::VectorXd generalised_force(const Model& model, const Kinematics& kin,
                                  const Matrix6Xd& wrench);
void generalised_force(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                       Eigen::VectorXd& force);

}  // namespace hagfish
