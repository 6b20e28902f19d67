#include "core/log/means/thigmotaxis_rows.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {

ThigmotaxisRow thigmotaxis_row(const Control& control, const StepSolution& solution, std::size_t i,
                               double h) {
  const Row& row = solution.rows[i];
  const ThigmotaxisCommand& of = control.thigmotaxis[static_cast<std::size_t>(row.command)];
  const auto index = static_cast<Eigen::Index>(i);
  ThigmotaxisRow r;
  r.end = of.end;
  r.along_a = along_a(row);
  r.towards = of.towards;
  r.spline_a = row.points().a.parameter;
  r.spline_b = row.points().b.parameter;
  r.command = row.rhs;
  r.cap = row.upper / h;
  r.lambda = solution.lambda[index] / h;
  r.speed = solution.excess[index] + row.rhs;
  r.slack = std::max(r.command - r.speed, 0.0);
  return r;
}

ThigmotaxisRows thigmotaxis_rows_of(const Control& control, const StepSolution& solution,
                                    double h) {
  ThigmotaxisRows rows;
  rows.command.fill(NAN);
  rows.speed.fill(NAN);
  rows.slack.fill(NAN);
  rows.met = true;
  for (std::size_t i = 0; i < solution.rows.size(); ++i) {
    if (solution.rows[i].kind != RowKind::thigmotaxis) continue;
    const ThigmotaxisRow row = thigmotaxis_row(control, solution, i, h);
    const bool other = row.end == KnotEnd::neither;
    rows.any = true;
    rows.sum += row.lambda;
    rows.met = rows.met && meets_command(row.slack, other ? 0 : row.command);
    if (other) {
      ++rows.others;
      rows.others_slack = std::fmax(rows.others_slack, row.slack);
      continue;
    }
    const std::size_t k = 2 * static_cast<std::size_t>(row.end) + (row.along_a ? 0 : 1);
    rows.present[k] = true;
    rows.lambda[k] = row.lambda;
    rows.command[k] = row.command;
    rows.speed[k] = row.speed;
    rows.slack[k] = row.slack;
    rows.cap = row.cap;
  }
  rows.met = rows.met && rows.any;
  return rows;
}

}  // namespace hagfish
