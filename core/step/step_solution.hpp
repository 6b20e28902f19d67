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
/// Names in the order of the enumeration.
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
  Eigen::VectorXd step_velocity, mean_velocity;  ///< velocities of Midway in the last pass, nv
};

struct StepSolution {
  Eigen::VectorXd qdot;           ///< the step's velocity, which meets the rows, nv
  Eigen::VectorXd next;           ///< velocity after the step, nv; qdot by Euler's rule
  Eigen::VectorXd mean_velocity;  ///< velocity of springs, damping and drag, nv: qdot, or by the
                                  ///< midpoint rule the mean of those before and after
  Matrix6Xd mean_twist;           ///< bodies' twists at mean_velocity, 6 x N
  Eigen::Matrix3Xd mean_centre_velocity;  ///< velocities of their centres at it, 3 x N, cm/s
  Matrix6Xd twist;                        ///< bodies' twists at qdot, 6 x N
  Eigen::Matrix3Xd centre_velocity;       ///< velocities of their centres at qdot, 3 x N, cm/s
  BodyVelocities bodies() const { return {twist, centre_velocity}; }  ///< motion at qdot
  /// Motion at mean_velocity.
  BodyVelocities mean_bodies() const { return {mean_twist, mean_centre_velocity}; }
  ConstraintForces force;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip force as applied, dyn, world
  /// Total torque of the muscles as applied, dyn cm, nv; 0 at the root.
  Eigen::VectorXd active_torque;
  SolveKind kind = SolveKind::linear;
  std::vector<Row> rows;           ///< rows of the problem, in the order of order_in_step
  std::vector<PathRow> path_rows;  ///< rows that were added along the step's path
  Eigen::Index prescribed = 0;     ///< number of prescribed rows, the first of `rows`
  /// Multipliers of Eq. 3 or 4 at `qdot`, dyn s or dyn cm s.
  Eigen::VectorXd multipliers;
  /// λ of the whole step, in the same units: λ / h is a row's mean force. Euler's rule: the
  /// multipliers. Midpoint rule: twice these, less the row's impact.
  Eigen::VectorXd lambda;
  /// C q̇ - d of each row at the solution, with the yield of flesh, cm/s or rad/s.
  Eigen::VectorXd excess;
  int active = 0;      ///< rows with a force
  int iterations = 0;  ///< iterations of the back end, all rounds together
  /// QP rounds. Each adds violated rows and releases prescribed limits with λ < 0.
  int rounds = 0;
  /// (H x - g) / reach without the active torque in H and g, nv; x is mean_velocity. It follows
  /// from the motion alone. It must equal active_torque + force.total().
  Eigen::VectorXd net_force;
  /// |H x - g - reach force.total()| over the largest of H x, g and each kind of force times reach.
  double stationarity = 0;
  KktResiduals kkt;  ///< residuals of rows not prescribed, on the scale of all rows
  /// The largest of `stationarity` and the residuals of `kkt`.
  double worst_residual() const { return std::max(kkt.worst(), stationarity); }
  double qp_time = 0;  ///< s spent in the QP back end
  StepSystem system;   ///< Eq. 1 as assembled
  StepMiddle middle;   ///< passes of the midpoint rule
};

}  // namespace hagfish
