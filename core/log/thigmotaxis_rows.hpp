// The rows of Eq. 6 of a step as solved, in the order of the log.
#pragma once

#include <array>
#include <limits>

#include "core/step/step.hpp"

namespace hagfish {

/// The four rows of Eq. 6: first t_a, first t_b, last t_a, last t_b.
struct ThigmotaxisRows {
  std::array<bool, 4> present{};
  std::array<double, 4> lambda{};   ///< over h, dyn; 0 where there is no row
  std::array<double, 4> command{};  ///< right side of Eq. 6, cm/s; nan where no row
  std::array<double, 4> speed{};    ///< left side of Eq. 6 at the solution, cm/s; nan where no row
  /// Shortfall of the command, whether by controller.cap or controller.acceleration, cm/s; nan
  /// where no row.
  std::array<double, 4> slack{};
  double cap = std::numeric_limits<double>::quiet_NaN();  ///< of their λ / h, dyn; nan: no row
  bool any = false;
  bool met = false;  ///< all rows at their commanded speed without slack
};

/// Throws std::invalid_argument where the step commands more than two contacts: a log holds those
/// of the first and the last one.
ThigmotaxisRows thigmotaxis_rows_of(const Control& control, const StepSolution& solution, double h);

/// Whether a row counts as met: its slack against its command, both cm/s.
bool meets_command(double slack, double command);

}  // namespace hagfish
