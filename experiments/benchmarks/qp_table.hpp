// How a report on back ends is shown to people.
#pragma once

#include <string>

#include "experiments/benchmarks/qp_measure.hpp"

namespace hagfish {

/// Quantile of a back end's times, beside their median.
inline constexpr double upper_quantile = 0.99;

/// What was measured: the QPs of `file`, their warm starts, each solved `repeat` times.
void print_qp_heading(const std::string& file, const QpReport& report, int repeat);
/// A row for each back end and start.
void print_qp_table(const QpReport& report);

}  // namespace hagfish
