#include "core/step/step.hpp"

#include <algorithm>

#include "core/step/rows/row_selection.hpp"

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

Status StepSolver::resume(const StepInput& in, const std::vector<PathRow>& missed,
                          StepSolution& step) {
  // A row with the id of an earlier one takes its place, and so keeps its multiplier.
  for (const PathRow& row : missed) {
    put_row(row.row, step.rows);
    const auto same = [&row](const PathRow& other) { return other.row.id == row.row.id; };
    const auto place = std::ranges::find_if(step.path_rows, same);
    if (place == step.path_rows.end()) {
      step.path_rows.push_back(row);
    } else {
      *place = row;
    }
  }
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
  if (status.ok()) finish(in, step);
  return status;
}

}  // namespace hagfish
