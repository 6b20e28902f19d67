// One time step (paper, 3.1): Eq. 1, 3 or 4 for the new velocity. Eq. 2 is advance() in
// core/chain/state.hpp.
#pragma once

#include <functional>
#include <string>

#include "core/step/euler_rule.hpp"
#include "core/step/midpoint/midpoint_rule.hpp"
#include "core/step/step_report.hpp"

namespace hagfish {

/// Solves steps, one after the other, by the scene's time rule. A step is begun, resumed as often
/// as rows are added to its solution, and finished; or solved at once. Copies have a back end and
/// storage of their own.
class StepSolver {
 public:
  /// `back_end`: one of box_qp_solver_names(). Throws std::invalid_argument otherwise.
  explicit StepSolver(std::string back_end) : rounds_(std::move(back_end)) {}

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
  void stop_when(std::function<bool()> asked) { rounds_.stop_when(std::move(asked)); }

  /// Where the equations of the step last begun hold, which `in` is the input of.
  StepPlace place(const StepInput& in) const {
    return by_euler(in) ? euler_.place(in) : midpoint_.place(in);
  }

  /// Its rows and what answers to them.
  const RowProblem& problem() const { return rounds_.problem(); }

  /// What the last step left for the next one, or a pass for the next.
  WarmStart warm;

 private:
  static bool by_euler(const StepInput& in) { return in.scene.time.rule == TimeRule::euler; }
  StepRule& rule_of(const StepInput& in);

  Rounds rounds_;
  EulerRule euler_;
  MidpointRule midpoint_;
  ReportStorage report_;
};

}  // namespace hagfish
