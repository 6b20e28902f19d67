// The solution of a step: velocities, multipliers, forces, residuals.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/step/rows/row.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Eq. 1, Eq. 3 (with limits as bilateral rows too) or Eq. 4.
enum class SolveKind : std::uint8_t { linear, kkt, qp };
/// In the order of the enumeration.
inline constexpr std::array solve_kind_names = {"linear", "kkt", "qp"};

/// Multiplier forces C'λ / h (paper, Eqs. 7 and 8), generalised, nv each.
struct ConstraintForces : ByKind<Eigen::VectorXd> {
  /// Writes their sum into `sum` (nv).
  void total(Eigen::VectorXd& sum) const;
  Eigen::VectorXd total() const;
};

/// The result of the passes of the midpoint rule. Euler's rule leaves these values as initialised.
struct StepMiddle {
  /// 0 if the velocity of the middle converges in the passes that the scene permits. Else the
  /// change in the last pass, rad/s and cm/s; infinite where a pass failed.
  double unsettled = 0;
  /// The change that all further passes would make, as a multiple of the last change. A step of two
  /// passes or more measures it, other steps guess it from earlier ones; 1 where unknown.
  double remaining = 1;
  /// Number of passes. After more than time.passes the bias is not balanced (Midway::balanced).
  int passes = 0;
  /// Norm of the difference between qdot and the velocity that placed the middle, rad/s and cm/s.
  double off = 0;
  Eigen::VectorXd step_velocity, mean_velocity;  ///< as in Midway, of the last pass, nv
};

struct StepSolution {
  Eigen::VectorXd qdot;           ///< the step's velocity, which meets the rows, nv
  Eigen::VectorXd next;           ///< velocity after the step, nv; qdot by Euler's rule
  Eigen::VectorXd mean_velocity;  ///< at which springs, damping and drag act, nv: qdot; midpoint
                                  ///< rule: mean of the velocities before and after
  Matrix6Xd mean_twist;           ///< of the bodies at mean_velocity, 6 x N
  Eigen::Matrix3Xd mean_centre_velocity;  ///< of their centres at mean_velocity, 3 x N, cm/s
  Matrix6Xd twist;                        ///< of the bodies at qdot, 6 x N
  Eigen::Matrix3Xd centre_velocity;       ///< of their centres at qdot, 3 x N, cm/s
  BodyVelocities bodies() const { return {twist, centre_velocity}; }  ///< at qdot
  ConstraintForces force;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip force as applied, dyn, world
  /// Total torque of the muscles as applied, dyn cm, nv; 0 at the root.
  Eigen::VectorXd active_torque;
  SolveKind kind = SolveKind::linear;
  std::vector<Row> rows;           ///< of the problem, in the order of place_in_step
  std::vector<PathRow> path_rows;  ///< rows that were added along the step's path
  Eigen::Index prescribed = 0;     ///< number of prescribed rows, the first of `rows`
  Eigen::VectorXd lambda;          ///< their multipliers, dyn s or dyn cm s
  Eigen::VectorXd excess;          ///< C q̇ - d of each row at the solution, cm/s or rad/s
  int active = 0;                  ///< rows with a force
  int iterations = 0;              ///< of the back end, all rounds together
  /// QP rounds. Each adds violated rows and releases prescribed limits with λ < 0.
  int rounds = 0;
  /// (H q̇ - g) / h without the active torque, nv. It follows from the motion alone. It equals the
  /// sum of the active torque and the forces of all rows.
  Eigen::VectorXd net_force;
  double stationarity = 0;  ///< |H q̇ - g - C'λ| over the largest of these three, infinity norms
  KktResiduals kkt;         ///< of the rows that are not prescribed, on the scale of all rows
  /// The largest of `stationarity` and the residuals of `kkt`.
  double worst_residual() const { return std::max(kkt.worst(), stationarity); }
  double qp_time = 0;  ///< s spent in the QP back end
  StepSystem system;   ///< Eq. 1 as assembled
  StepMiddle middle;   ///< of the midpoint rule
};

}  // namespace hagfish
