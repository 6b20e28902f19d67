// One time step (paper, 3.1): Eq. 1, 3 or 4 for the new velocity. Eq. 2 is advance() in
// core/chain/state.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/contact/observation.hpp"
#include "core/step/dual_problem.hpp"
#include "core/step/midway.hpp"
#include "core/step/outcome.hpp"
#include "core/step/rows.hpp"
#include "core/step/warm_start.hpp"
#include "solvers/box_qp.hpp"
#include "solvers/fixed_point.hpp"

namespace hagfish {

/// What the controller asks of a step.
struct Control {
  bool clamp_head = true;
  TipForce tip;
  std::vector<ThigmotaxisCommand> thigmotaxis;  ///< rows of Eq. 6 at any number of contacts
  /// Angles that muscles pull the hinges to, rad, nv, 0 at the root; empty where they do not.
  Eigen::VectorXd rest_shape;
  ActiveTorque torque;  ///< torques asked for besides; empty, or 0, where none are
  ActiveTorque active;  ///< towards the rest shape, which follows from it (active_curvature.hpp)
};

/// All that a step depends on, but for the warm start.
struct StepInput {
  const Model& model;
  const Scene& scene;
  const State& state;
  const Observation& observation;  ///< of `state`
  const Control& control;
  /// Where the step's equations hold, which `begin` finds: storage of the midpoint rule. Null: at
  /// `state`, Euler's rule.
  Midway* midway = nullptr;

  /// What Eq. 1 and the rows are of.
  const Kinematics& kin() const { return midway == nullptr ? observation.kin : midway->kin; }
  const std::vector<SplineSegment>& segments() const {
    return midway == nullptr ? observation.segments : midway->segments;
  }
  /// Null where that is `state`: contacts are then as they were found.
  const std::vector<SplineSegment>* moved_segments() const {
    return midway == nullptr ? nullptr : &midway->segments;
  }
  /// The motion there.
  StepMotion motion() const {
    return midway == nullptr ? motion_of(observation.kin) : midway->motion();
  }
};

/// Eq. 1, Eq. 3 (with limits as bilateral rows too) or Eq. 4.
enum class SolveKind : std::uint8_t { linear, kkt, qp };
/// In the order of the enumeration.
inline constexpr std::array solve_kind_names = {"linear", "kkt", "qp"};

/// Multiplier forces C'λ / h (paper, Eqs. 7 and 8), generalised, nv each.
struct ConstraintForces {
  std::array<Eigen::VectorXd, row_kinds.size()> of_kind;

  Eigen::VectorXd& operator[](RowKind kind) { return of_kind[static_cast<std::size_t>(kind)]; }
  const Eigen::VectorXd& operator[](RowKind kind) const {
    return of_kind[static_cast<std::size_t>(kind)];
  }
  /// Their sum into `sum` (nv).
  void total(Eigen::VectorXd& sum) const;
  Eigen::VectorXd total() const;
};

/// What a step takes `remaining` (StepSolution) as from the one before: the measure of a step fades
/// towards 1 by this power, so that it is taken anew each ten steps or so (after Hairer and Wanner,
/// Solving Ordinary Differential Equations II, IV.8).
inline double guessed_remaining(double before) { return std::pow(before, 0.9); }

struct StepSolution {
  Eigen::VectorXd base;  ///< q̇ with the reactions of rows prescribed when it was found alone, nv
  Eigen::VectorXd qdot;  ///< velocity that meets the rows and by which the step moves, nv
  Eigen::VectorXd next;  ///< velocity after the step, nv: by Euler's rule, qdot
  Eigen::VectorXd felt;  ///< that springs, damping and drag act on, nv: qdot; midpoint: the mean
                         ///< of the velocities before and after
  Matrix6Xd felt_twist;  ///< of the bodies at it, 6 x N
  Eigen::Matrix3Xd felt_centre_velocity;  ///< of their centres at it, 3 x N, cm/s
  Matrix6Xd twist;                        ///< of the bodies at it, 6 x N
  Eigen::Matrix3Xd centre_velocity;       ///< of the bodies' centres at it, 3 x N, cm/s
  BodyVelocities bodies() const { return {twist, centre_velocity}; }  ///< at qdot
  ConstraintForces force;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< tip force as applied, dyn, world
  /// Active torque as applied, towards the rest shape and besides, dyn cm, nv; 0 at the root.
  Eigen::VectorXd active_torque;
  SolveKind kind = SolveKind::linear;
  /// Rows that entered the problem, in the order of place_in_step; where a round went on with the
  /// factor of the one before, those that it added and then those that it released come last.
  std::vector<Row> rows;
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
  /// What the last pass changed the middle's velocity by, rad/s and cm/s, where that does not
  /// settle in the passes that the scene permits, with its bias balanced or not; infinite where a
  /// pass failed; else 0 (midpoint rule).
  double unsettled = 0;
  /// What all further passes would change, over what the last one did: as measured in this step
  /// where it took two, else as guessed from those before; 1 where unknown (midpoint rule).
  double remaining = 1;
  /// That found the step's middle, the last time; 0 by Euler's rule. With more than time.passes its
  /// bias is not balanced (Midway::balanced).
  int passes = 0;
  /// Length of what qdot and the velocity that placed the middle differ by, rad/s and cm/s: what
  /// passes leave, as far as `remaining` lets them (midpoint rule; else 0).
  double middle_off = 0;
  struct {
    Eigen::VectorXd moved, felt;
  } middle;  ///< as in Midway, of the last pass
};

/// Storage for intermediate results. A step of as many rows as the one before, by Euler's rule,
/// allocates nothing.
struct StepScratch {
  std::vector<PrescribedVelocity> prescribed;  ///< of the rows that are
  ArticulatedFactor factor;
  bool factor_known = false;  ///< it is of this step's Eq. 1
  /// Velocities that `factor` has as prescribed, with those of released rows, as they are.
  std::vector<PrescribedVelocity> pinned;
  Eigen::VectorXd reaction;               ///< at those
  Eigen::VectorXd base_reaction;          ///< λ of the prescribed rows in step.base
  Matrix6Xd base_twist;                   ///< of the bodies at step.base, 6 x N
  Eigen::Matrix3Xd base_centre_velocity;  ///< of their centres, 3 x N, cm/s
  BodyVelocities base_bodies() const { return {base_twist, base_centre_velocity}; }
  std::vector<Row> violated;                       ///< rows that the last answer violates
  std::vector<std::pair<int, std::size_t>> order;  ///< of the rows: place_in_step, index
  std::vector<Row> ordered;
  RowColumns columns;
  BoxQp whole;              ///< of a round from nothing
  DualExtension extension;  ///< and of the one that goes on from there
  bool extended = false;    ///< the last round did
  /// Of the last round that had rows behind the prescribed ones, on those.
  const BoxQp& qp() const { return extended ? extension.qp : whole; }
  Eigen::VectorXd start, row_scale, scaled;
  BoxQpSolution solution;
  Matrix6Xd wrench;
  Eigen::VectorXd joint, impulse, change;
  // Of the step's middle (midpoint rule): velocities moved and felt, 2 nv.
  AndersonMixing passes;
  Eigen::VectorXd first_guess, placed_by, led_to, mixed;
  // Of the velocity after the step (midpoint rule).
  std::vector<std::size_t> held;            ///< prescribed rows, and
  std::vector<PrescribedVelocity> jumps;    ///< what their velocities change by
  std::vector<std::size_t> full;            ///< rows at their upper bound
  std::vector<std::size_t> hit;             ///< other rows with an impact
  std::vector<double> hit_A, hit_b, hit_x;  ///< Eq. 4 of those, and its answer
  ArticulatedFactor free_factor;            ///< with limits that would pull let go
  Eigen::VectorXd impact, half_change;
  Matrix6Xd impact_twist;
  Eigen::Matrix3Xd impact_centre_velocity;
};

/// Solves steps, one after the other. A step is begun, resumed as often as rows are added to its
/// solution, and finished; or solved at once. Copies have a back end and storage of their own.
class StepSolver {
 public:
  /// `back_end`: one of box_qp_solver_names(). Throws std::invalid_argument otherwise.
  explicit StepSolver(std::string back_end);
  StepSolver(const StepSolver& other);
  StepSolver& operator=(const StepSolver& other);
  StepSolver(StepSolver&&) = default;
  StepSolver& operator=(StepSolver&&) = default;
  ~StepSolver() = default;

  /// Eq. 1, the rows, and Eq. 3 or 4: step.qdot is a velocity that meets all rows. By the midpoint
  /// rule again, until the step's middle is where that leads. Not ok where a number is not finite,
  /// rows contradict each other or the back end fails.
  Status begin(const StepInput& in, StepSolution& step);

  /// Eq. 3 or 4 again, after rows were added to step.rows and step.path_rows. By the midpoint rule
  /// the step's middle is found anew where these move it. Status as above.
  Status resume(const StepInput& in, StepSolution& step);

  /// Forces and residuals of the step as solved; keeps its multipliers in `warm`.
  void finish(const StepInput& in, StepSolution& step);

  /// begin and finish.
  Status solve(const StepInput& in, StepSolution& step);

  /// A step ends, not ok (stopped), soon after `asked` returns true: it is called at each iteration
  /// of the back end. Copies are asked the same.
  void stop_when(std::function<bool()> asked);

  /// What the last step left for the next one, or a pass for the next.
  WarmStart warm;

  /// Whether a round that releases or adds few rows goes on with the factor of the round before.
  /// Without, scratch() has the factor of just the rows that the solution prescribes.
  bool extends_rounds = true;

  /// Intermediate results of the last step.
  const StepScratch& scratch() const { return scratch_; }

 private:
  void guess_middle(const StepInput& in);
  Status settle(const StepInput& in, StepSolution& step);
  Status find_middle(const StepInput& in, bool balanced, StepSolution& step);
  Status begin_here(const StepInput& in, StepSolution& step);
  Status constrained_motion(const StepInput& in, StepSolution& step);
  Status whole_round(const StepInput& in, StepSolution& step);
  bool factor_is_current(const StepSolution& step) const;
  bool change_rows(const StepInput& in, StepSolution& step);
  bool extended_round(const StepInput& in, StepSolution& step);
  void move_released_back(StepSolution& step);
  void order_rows(const Model& model, StepSolution& step);
  Status base_motion(const StepInput& in, StepSolution& step);
  void set_velocity(const StepInput& in, StepSolution& step);
  bool find_impacts(const StepInput& in, StepSolution& step);
  double coupling(const StepSolution& step, Eigen::Index i, std::size_t row) const;
  void solve_hit(const StepSolution& step);
  void solve_impacts(const StepInput& in, StepSolution& step);
  void respond(const StepInput& in, const ArticulatedFactor& factor, StepSolution& step);
  bool release_held(const StepInput& in, StepSolution& step);
  Status set_next_velocity(const StepInput& in, StepSolution& step);
  bool solve_multipliers(StepSolution& step);
  bool add_violated(const StepInput& in, StepSolution& step);
  void keep_pass(const StepSolution& step);
  void measure_rows(StepSolution& step);
  void keep_active(const StepSolution& step);

  std::string back_end_;
  std::function<bool()> stop_;
  std::unique_ptr<BoxQpSolver> solver_;
  StepScratch scratch_;
};

}  // namespace hagfish
