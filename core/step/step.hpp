// One time step (paper, 3.1): Eq. 1, 3 or 4 for the new velocity. Eq. 2 is advance() in
// core/chain/state.hpp.
#pragma once

#include <functional>
#include <string>

#include "core/step/midpoint/midpoint_rule.hpp"
#include "core/step/step_report.hpp"

namespace hagfish {

/// Solves steps, one after the other, by the scene's time rule. A caller begins a step, resumes it
/// with rows that its path misses, and finishes it; solve() does this at once. The solution is
/// output: no one else writes into it. A copy has its own back end and storage.
class StepSolver {
 public:
  /// `back_end`: one of box_qp_solver_names(). Throws std::invalid_argument otherwise.
  explicit StepSolver(std::string back_end) : rounds_(std::move(back_end)) {}

  /// Solves Eq. 1, and Eq. 3 or 4 on the rows: step.qdot becomes a velocity that meets all rows.
  /// The midpoint rule repeats this until the middle of the step converges. Not ok where a number
  /// is not finite, rows contradict each other or the back end fails.
  Status begin(const StepInput& in, StepSolution& step);

  /// Solves Eq. 3 or 4 again with the rows `missed` as well (look_ahead.hpp). The midpoint rule
  /// finds the middle of the step again if these rows move it. Status as above.
  Status resume(const StepInput& in, const std::vector<PathRow>& missed, StepSolution& step);

  /// Computes forces and residuals of the solved step, and keeps its multipliers in `warm`.
  void finish(const StepInput& in, StepSolution& step);

  /// begin and finish.
  Status solve(const StepInput& in, StepSolution& step);

  /// A step ends with the outcome `stopped` soon after `asked` returns true, which is called at
  /// each iteration of the back end. Copies call it too.
  void stop_when(std::function<bool()> asked) { rounds_.stop_when(std::move(asked)); }

  /// The place where the equations of the last begun step hold; `in` is the input of that step.
  StepPlace place(const StepInput& in) const {
    return by_euler(in) ? euler_.place(in) : midpoint_.place(in);
  }

  /// The rows of the last step and their response.
  const RowProblem& problem() const { return rounds_.problem(); }

  /// Start values that the last step leaves for the next step, or a pass for the next pass.
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
