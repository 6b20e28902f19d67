#include "core/step/step.hpp"

namespace hagfish {

StepRule& StepSolver::rule_of(const StepInput& in) {
  if (by_euler(in)) return euler_;
  return midpoint_;
}

Status StepSolver::begin(const StepInput& in, StepSolution& step) {
  step.path_rows.clear();
  step.middle = {};
  return rule_of(in).begin(in, rounds_, warm, step);
}

Status StepSolver::resume(const StepInput& in, StepSolution& step) {
  return rule_of(in).resume(in, rounds_, warm, step);
}

void StepSolver::finish(const StepInput& in, StepSolution& step) {
  measure_rows(rounds_.problem(), report_, step);
  keep_active(report_, step, warm);
  rule_of(in).end(in, warm, step);
  report_forces(in, place(in), report_, step);
}

Status StepSolver::solve(const StepInput& in, StepSolution& step) {
  Status status = begin(in, step);
  if (status.ok()) {
    finish(in, step);
  }
  return status;
}

}  // namespace hagfish
