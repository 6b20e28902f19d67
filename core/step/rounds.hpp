// Eqs. 3 and 4 of a step on its rows, in rounds. They lead from Eq. 1 and the rows near binding to
// multipliers and a velocity that meets all rows. They do not depend on the time rule, which gives
// the place where the equations hold.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/step/outcome.hpp"
#include "core/step/rows/dual_problem.hpp"
#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"
#include "core/step/warm_start.hpp"

namespace hagfish {

/// Eq. 3 or 4 of a step in its last round: the response of velocities to forces, and of rows to
/// multipliers.
struct RowProblem {
  ArticulatedFactor factor;                    ///< H⁻¹ at fixed `prescribed` velocities
  std::vector<PrescribedVelocity> prescribed;  ///< velocities of the prescribed rows
  Eigen::VectorXd base;                        ///< q̇ with the prescribed rows alone, nv
  Matrix6Xd base_twist;                        ///< twists of the bodies at `base`, 6 x N
  Eigen::Matrix3Xd base_centre_velocity;       ///< velocities of their centres, 3 x N, cm/s
  RowColumns columns;                          ///< H⁻¹ on the other rows
  BoxQp qp;                                    ///< Eq. 4 on the other rows: A and b
  Eigen::VectorXd start;                       ///< multipliers that the back end started from

  BodyVelocities base_bodies() const { return {base_twist, base_centre_velocity}; }
};

/// Solves steps round by round, one step after the other. A copy has its own back end and storage.
class Rounds {
 public:
  /// `back_end`: one of box_qp_solver_names(). Throws std::invalid_argument otherwise.
  explicit Rounds(std::string back_end);
  Rounds(const Rounds& other);
  Rounds& operator=(const Rounds& other) { return *this = Rounds(other); }
  Rounds(Rounds&&) = default;
  Rounds& operator=(Rounds&&) = default;
  ~Rounds() = default;

  /// Solves Eq. 1, and Eq. 3 or 4 on the rows at `place` and those of step.path_rows: step.qdot
  /// becomes a velocity that meets all rows. Not ok where a number is not finite, rows contradict
  /// each other or the back end fails.
  Status begin(const StepInput& in, const StepPlace& place, const WarmStart& warm,
               StepSolution& step);

  /// Solves Eq. 3 or 4 again, after rows were added to step.rows. Status as above.
  Status resume(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                StepSolution& step);

  /// StepSolver::stop_when for these rounds.
  void stop_when(std::function<bool()> asked);

  /// The problem of the last step.
  const RowProblem& problem() const { return problem_; }

 private:
  Status round(const StepInput& in, const StepPlace& place, const WarmStart& warm,
               StepSolution& step);
  bool factor_is_current(const StepSolution& step) const;
  bool change_rows(const StepInput& in, const StepPlace& place, StepSolution& step);
  void order_rows(const Model& model, const WarmStart& warm, StepSolution& step);
  Status base_motion(const StepInput& in, const StepPlace& place, StepSolution& step);
  void set_velocity(const StepInput& in, const StepPlace& place, StepSolution& step);
  bool solve_multipliers(StepSolution& step);
  bool add_violated(const StepInput& in, const StepPlace& place, StepSolution& step);

  std::string back_end_;
  std::function<bool()> stop_;
  std::unique_ptr<BoxQpSolver> solver_;
  RowProblem problem_;
  bool factor_known_ = false;  ///< problem_.factor is of this step's Eq. 1
  // Storage. A step with as many rows as the last one allocates nothing.
  std::vector<Row> violated_;                       ///< rows that the last answer violates
  std::vector<std::pair<int, std::size_t>> order_;  ///< order_in_step and index of each row
  std::vector<Row> ordered_;
  BoxQpSolution solution_;
  Matrix6Xd wrench_;
  Eigen::VectorXd joint_, reaction_;
};

/// The status of `solution`, a back end's failed answer to `qp`, the problem on `rows`. It names
/// the rows that contradict each other, which the active-set method finds if the back end did not.
/// Without such rows it names the row with the largest violation.
Status describe_failure(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                        const BoxQpSolution& solution);

}  // namespace hagfish
