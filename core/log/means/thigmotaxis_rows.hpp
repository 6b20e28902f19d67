// The rows of Eq. 6 of a step as solved, in the order of the log.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// One row of Eq. 6.
struct ThigmotaxisRow {
  KnotEnd end = KnotEnd::neither;
  bool along_a = true;                ///< whether it is along t_a, not t_b
  BodyEnd towards = BodyEnd::head;    ///< end of the body as commanded
  double spline_a = 0, spline_b = 0;  ///< spline parameters, segment + t
  double command = 0;                 ///< right side of Eq. 6, cm/s
  double cap = 0;                     ///< bound of λ / h, dyn
  double lambda = 0;                  ///< λ / h, dyn
  double speed = 0;                   ///< left side of Eq. 6 at the solution, cm/s
  /// Shortfall of the command, cm/s: only of a row at its cap.
  double slack = 0;
};

/// Row `i` of a step as solved with `control`, which is of kind thigmotaxis.
ThigmotaxisRow thigmotaxis_row(const Control& control, const StepSolution& solution, std::size_t i,
                               double h);

/// How descriptions of datasets tell the order of the rows below.
inline const std::string strand_order = "first t_a, first t_b, last t_a, last t_b: ";

/// The four rows of Eq. 6 at the knot's ends: first t_a, first t_b, last t_a, last t_b; and what
/// there is of others.
struct ThigmotaxisRows {
  std::array<bool, 4> present{};
  std::array<double, 4> lambda{};   ///< λ / h, dyn; 0 where there is no row
  std::array<double, 4> command{};  ///< right side of Eq. 6, cm/s; nan where no row
  std::array<double, 4> speed{};    ///< left side of Eq. 6 at the solution, cm/s; nan where no row
  std::array<double, 4> slack{};    ///< cm/s; nan where no row
  double cap = NAN;                 ///< bound of λ / h, dyn; nan: no row
  double sum = 0;                   ///< sum of the multipliers of all rows over h, dyn
  int others = 0;                   ///< rows at other contacts
  double others_slack = NAN;        ///< the largest of theirs, cm/s
  bool any = false;
  /// All rows at their commanded speed without slack; others to within that of a command of 0.
  bool met = false;
};

ThigmotaxisRows thigmotaxis_rows_of(const Control& control, const StepSolution& solution, double h);

}  // namespace hagfish
