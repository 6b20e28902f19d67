// Eqs. 3 and 4 of a step on its rows, in rounds: from Eq. 1 and rows near binding to multipliers
// and the velocity that meets all rows. Knows no time rule: where the equations hold is given.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/step/dual_problem.hpp"
#include "core/step/outcome.hpp"
#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"
#include "core/step/warm_start.hpp"

namespace hagfish {

/// Eq. 3 or 4 of a step in its last round: how velocities answer to forces, and rows to
/// multipliers.
struct RowProblem {
  ArticulatedFactor factor;                    ///< H⁻¹, with `prescribed` kept
  std::vector<PrescribedVelocity> prescribed;  ///< velocities that rows prescribe
  Eigen::VectorXd base;                        ///< q̇ with the prescribed rows alone, nv
  Matrix6Xd base_twist;                        ///< twists of the bodies at `base`, 6 x N
  Eigen::Matrix3Xd base_centre_velocity;       ///< velocities of their centres, 3 x N, cm/s
  RowColumns columns;                          ///< H⁻¹ on the other rows
  BoxQp qp;                                    ///< Eq. 4 on the other rows: A and b
  Eigen::VectorXd start;                       ///< multipliers that the back end started from

  BodyVelocities base_bodies() const { return {base_twist, base_centre_velocity}; }
};

/// Solves steps round by round, one step after the other. Copies have a back end and storage of
/// their own.
class Rounds {
 public:
  /// `back_end`: one of box_qp_solver_names(). Throws std::invalid_argument otherwise.
  explicit Rounds(std::string back_end);
  Rounds(const Rounds& other);
  Rounds& operator=(const Rounds& other);
  Rounds(Rounds&&) = default;
  Rounds& operator=(Rounds&&) = default;
  ~Rounds() = default;

  /// Eq. 1 and the rows at `place`, with those of step.path_rows, and Eq. 3 or 4: step.qdot is a
  /// velocity that meets all rows. Not ok where a number is not finite, rows contradict each other
  /// or the back end fails.
  Status begin(const StepInput& in, const StepPlace& place, const WarmStart& warm,
               StepSolution& step);

  /// Eq. 3 or 4 again, after rows were added to step.rows. Status as above.
  Status resume(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                StepSolution& step);

  /// As StepSolver::stop_when.
  void stop_when(std::function<bool()> asked);

  /// That of the last step.
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
  // Storage. A step of as many rows as the one before allocates nothing.
  std::vector<Row> violated_;                       ///< rows that the last answer violates
  std::vector<std::pair<int, std::size_t>> order_;  ///< of the rows: place_in_step, index
  std::vector<Row> ordered_;
  BoxQpSolution solution_;
  Matrix6Xd wrench_;
  Eigen::VectorXd joint_, reaction_;
};

}  // namespace hagfish
