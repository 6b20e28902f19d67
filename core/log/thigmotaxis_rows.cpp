#include "core/log/thigmotaxis_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hagfish {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// Relative to the commanded speed, or to 1 cm/s where that is less: Ipopt's tolerance moves the
// speed of a row by 1e-8 of the largest in the step.
constexpr double slack_tolerance = 1e-6;

}  // namespace

bool meets_command(double slack, double command) {
  return slack <= slack_tolerance * std::max(1.0, std::abs(command));
}

ThigmotaxisRows thigmotaxis_rows_of(const Control& control, const StepSolution& solution,
                                    double h) {
  ThigmotaxisRows rows;
  rows.command.fill(nan);
  rows.speed.fill(nan);
  rows.slack.fill(nan);
  rows.met = true;
  for (std::size_t i = 0; i < solution.rows.size(); ++i) {
    const Row& row = solution.rows[i];
    if (row.kind != RowKind::thigmotaxis) {
      continue;
    }
    const auto place = static_cast<std::size_t>(thigmotaxis_place(row));
    if (place >= rows.lambda.size()) {
      throw std::invalid_argument(
          "controller commands thigmotaxis at more than two contacts, of which a log holds the "
          "first and the last");
    }
    const auto index = static_cast<Eigen::Index>(i);
    rows.present[place] = true;
    rows.lambda[place] = solution.lambda[index] / h;
    const ThigmotaxisSpeeds& speed = control.thigmotaxis[place / 2].speed;
    rows.command[place] = place % 2 == 0 ? speed.a : speed.b;
    rows.speed[place] = solution.excess[index] + row.rhs;
    rows.slack[place] = std::max(rows.command[place] - rows.speed[place], 0.0);
    rows.met = rows.met && meets_command(rows.slack[place], rows.command[place]);
    rows.cap = row.upper / h;
    rows.any = true;
  }
  rows.met = rows.met && rows.any;
  return rows;
}

}  // namespace hagfish
