// What a step came to: velocities, multipliers, forces, residuals.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/step/rows.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Eq. 1, Eq. 3 (with limits as bilateral rows too) or Eq. 4.
enum class SolveKind : std::uint8_t { linear, kkt, qp };
/// In the order of the enumeration.
inline constexpr std::array solve_kind_names = {"linear", "kkt", "qp"};

/// Multiplier forces C'λ / h (paper, Eqs. 7 and 8), generalised, nv each.
struct ConstraintForces : ByKind<Eigen::VectorXd> {
  /// Their sum into `sum` (nv).
  void total(Eigen::VectorXd& sum) const;
  Eigen::VectorXd total() const;
};

/// What the passes of the midpoint rule came to; as it begins by Euler's.
struct StepMiddle {
  /// What the last pass changed the middle's velocity by, rad/s and cm/s, where that does not
  /// settle in the passes that the scene permits, with its bias balanced or not; infinite where a
  /// pass failed; else 0.
  double unsettled = 0;
  /// What all further passes would change, over what the last one did: as measured in this step
  /// where it took two, else as guessed from those before; 1 where unknown.
  double remaining = 1;
  /// That found the middle, the last time. With more than time.passes its bias is not balanced
  /// (Midway::balanced).
  int passes = 0;
  /// Length of what qdot and the velocity that placed the middle differ by, rad/s and cm/s: what
  /// passes leave, as far as `remaining` lets them.
  double off = 0;
  Eigen::VectorXd step_velocity, mean_velocity;  ///< as in Midway, of the last pass, nv
};

struct StepSolution {
  Eigen::VectorXd qdot;           ///< velocity that meets the rows and by which the step moves, nv
  Eigen::VectorXd next;           ///< velocity after the step, nv: by Euler's rule, qdot
  Eigen::VectorXd mean_velocity;  ///< that springs, damping and drag act on, nv: qdot; midpoint:
                                  ///< the mean of the velocities before and after
  Matrix6Xd mean_twist;           ///< of the bodies at it, 6 x N
  Eigen::Matrix3Xd mean_centre_velocity;  ///< of their centres at it, 3 x N, cm/s
  Matrix6Xd twist;                        ///< of the bodies at it, 6 x N
  Eigen::Matrix3Xd centre_velocity;       ///< of the bodies' centres at it, 3 x N, cm/s
  BodyVelocities bodies() const { return {twist, centre_velocity}; }  ///< at qdot
  ConstraintForces force;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip force as applied, dyn, world
  /// Active torque as applied, towards the rest shape and besides, dyn cm, nv; 0 at the root.
  Eigen::VectorXd active_torque;
  SolveKind kind = SolveKind::linear;
  std::vector<Row> rows;           ///< that entered the problem, in the order of place_in_step
  std::vector<PathRow> path_rows;  ///< of them, what the step's path showed
  Eigen::Index prescribed = 0;     ///< how many of them, the first, are prescribed
  Eigen::VectorXd lambda;          ///< their multipliers, dyn s or dyn cm s
  Eigen::VectorXd excess;          ///< C q̇ - d of each row at the solution, cm/s or rad/s
  int active = 0;                  ///< rows with a force
  int iterations = 0;              ///< of the back end, all rounds together
  /// QP rounds: each adds violated rows and releases prescribed limits with λ < 0.
  int rounds = 0;
  /// (H q̇ - g) / h but for the active torque: what this and the forces of all rows add up to, from
  /// the motion alone, nv.
  Eigen::VectorXd net_force;
  double stationarity = 0;  ///< |H q̇ - g - C'λ| over the largest of these three, infinity norms
  KktResiduals kkt;  ///< of the rows not prescribed, on the scale of all; the others are exact
  /// The larger of `stationarity` and the residuals of `kkt`.
  double worst_residual() const { return std::max(kkt.worst(), stationarity); }
  double qp_time = 0;  ///< s spent in the QP back end
  StepSystem system;   ///< Eq. 1 as assembled
  StepMiddle middle;   ///< of the midpoint rule
};

}  // namespace hagfish
