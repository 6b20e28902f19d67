// One time step (paper, 3.1): Eq. 1, 3 or 4, then Eq. 2.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/contact/contact.hpp"
#include "core/step/dual_problem.hpp"
#include "core/step/rows.hpp"
#include "core/step/step_error.hpp"
#include "core/step/warm_start.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// What the step's state looks like: found once, used by controller, constraints and solver.
struct Observation {
  Kinematics kin;
  std::vector<SplineSegment> segments;
  ContactSet contact;
  double penetration = 0;      ///< deepest overlap of skins or with the head plate, cm, >= 0
  double limit_violation = 0;  ///< largest angle past a limit, rad, >= 0
};

void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Observation& observation);
Observation observe(const Model& model, const State& state, const Scene& scene);

/// Largest displacement of the head from where the clamp holds it, cm: of either end and of its
/// side, which shows a turn about its own axis.
double head_drift(const Model& model, const Kinematics& kin);

/// What the controller asks of a step.
struct Control {
  bool clamp_head = true;
  TipForce tip;
  std::vector<ThigmotaxisCommand> thigmotaxis;  ///< none, or first and last contact
};

/// Eq. 1, Eq. 3 (with limits that surely bind as bilateral rows too) or Eq. 4.
enum class SolveKind : std::uint8_t { linear, kkt, qp };

/// Multiplier forces C'λ / h by kind of row (paper, Eqs. 7 and 8), generalised, nv each.
struct ConstraintForces {
  Eigen::VectorXd head, limit, contact, wall, thigmotaxis;
  Eigen::VectorXd total() const { return head + limit + contact + wall + thigmotaxis; }
};

struct StepSolution {
  Eigen::VectorXd base;              ///< q̇ with the held rows' forces, but no others, nv
  Eigen::VectorXd qdot;              ///< new velocity, nv
  Matrix6Xd twist;                   ///< of the bodies at it, 6 x N
  Eigen::Matrix3Xd centre_velocity;  ///< of the bodies' centres at it, 3 x N, cm/s
  ConstraintForces force;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip force as applied, dyn, world
  SolveKind kind = SolveKind::linear;
  std::vector<Row> rows;   ///< rows that entered the problem: held, then from the tail on
  Eigen::Index held = 0;   ///< how many of them are held; the others are the QP's
  Eigen::VectorXd lambda;  ///< their multipliers, dyn s or dyn cm s
  Eigen::VectorXd excess;  ///< C q̇ - d of each row at the solution, cm/s or rad/s
  int active = 0;          ///< rows with a force
  int iterations = 0;      ///< of the back end, all rounds together
  /// Problems solved: rows left out at first and found violated come in, rows held that would have
  /// to pull are let go.
  int rounds = 0;
  /// (H q̇ - g) / h: what the forces of all rows add up to, from the motion alone, nv.
  Eigen::VectorXd net_force;
  double stationarity = 0;  ///< |H q̇ - g - C'λ| over the largest of these three, infinity norms
  KktResiduals kkt;    ///< of the rows not held, on the scale of all; those held are met exactly
  double qp_time = 0;  ///< s spent in the QP back end
  StepSystem system;   ///< Eq. 1 as assembled
};

/// Storage that a step needs on the way and keeps for the next: with it, nothing is allocated once
/// all has grown to size.
struct StepScratch {
  std::vector<HeldVelocity> held;
  ArticulatedFactor factor;
  Eigen::VectorXd holding;                         ///< what holds the held
  Eigen::Matrix3Xd base_centre_velocity;           ///< 3 x N, cm/s
  std::vector<Row> violated;                       ///< rows that the last answer violates
  std::vector<std::pair<int, std::size_t>> order;  ///< of the rows: place_in_step, which
  std::vector<Row> ordered;                        ///< storage for them
  RowColumns columns;
  BoxQp qp;
  Eigen::VectorXd start, scaled;
  BoxQpSolution solution;
  Matrix6Xd wrench;
  Eigen::VectorXd joint, impulse, change;
};

/// Solves for the new velocity, into `step`: begin_step and finish_step. Throws StepError where the
/// solver fails or a result is not finite.
void solve_step(const Model& model, const State& state, const Observation& observation,
                const Control& control, const Scene& scene, BoxQpSolver& solver, WarmStart& warm,
                StepScratch& scratch, StepSolution& step);

/// The rows of a step that bind or may do so, as far as one can tell beforehand, into `rows`.
void gather_rows(const Model& model, const State& state, const Observation& observation,
                 const Control& control, const Scene& scene, std::vector<Row>& rows);

/// Eq. 1, the rows, and Eq. 3 or 4: step.qdot is a velocity that meets all rows. Throws as above.
void begin_step(const Model& model, const State& state, const Observation& observation,
                const Control& control, const Scene& scene, BoxQpSolver& solver,
                const WarmStart& warm, StepScratch& scratch, StepSolution& step);

/// Eq. 4 anew, after rows have come to step.rows. Throws as above.
void resume_step(const Model& model, const State& state, const Observation& observation,
                 const Scene& scene, BoxQpSolver& solver, const WarmStart& warm,
                 StepScratch& scratch, StepSolution& step);

/// Forces and residuals of the step as solved; keeps its multipliers in `warm`.
void finish_step(const Model& model, const Observation& observation, const Control& control,
                 const Scene& scene, WarmStart& warm, StepScratch& scratch, StepSolution& step);

}  // namespace hagfish
