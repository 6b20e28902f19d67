// Back ends measured on a set of QPs.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "experiments/benchmarks/qp_set.hpp"
#include "solvers/qp_reference.hpp"

namespace hagfish {

/// Back ends that can be measured, by name.
std::vector<std::string> measured_back_ends();

/// A back end as it is to be measured.
struct BackEnd {
  std::string name;  ///< one of measured_back_ends()
  /// Where Ipopt stops, before crossover if it is polished; NaN: its default. A point that is
  /// not polished counts as solved at ten times that, at 1e-8 at least.
  double tolerance = std::numeric_limits<double>::quiet_NaN();
};

/// How a back end did from one kind of start. Worst values are over the QPs that it solved.
struct Performance {
  BackEnd back_end;
  bool warm = false;
  std::vector<double>
      time;        ///< time of each QP, s: wall time of solve() alone, the least of the repeats
  double kkt = 0;  ///< worst of kkt_residuals
  /// Worst of each; QPs without a reference do not count.
  VelocityError velocity;
  int failures = 0;
  std::int64_t iterations = 0;  ///< sum over all QPs
};

struct QpReport {
  std::vector<Performance> rows;
  std::vector<Eigen::Index> row_counts;  ///< number of rows of each QP
  std::size_t primal = 0;                ///< QPs that came in primal form
  std::size_t sequences = 0;
  std::size_t stored_starts = 0;      ///< warm starts that came with the QP
  std::size_t carried_starts = 0;     ///< starts that were the back end's answer to the QP before
  std::size_t without_reference = 0;  ///< QPs that were solved, though no reference was found
  std::vector<std::string> failures;  ///< group, back end, start and reason of the first ten
};

/// Solves every QP `repeat` times with each back end from zero and from a warm start, all back ends
/// in turn, so that none finds the caches as it left them. A warm start is the QP's own `start`
/// where it has one, else what the same back end answered to the QP before, where that is of the
/// same sequence with as many rows of each kind, else zero. Throws as QpSetReader does.
QpReport measure(const QpSetReader& set, const std::vector<BackEnd>& back_ends, int repeat);

/// The value that `share` (0 to 1) of the values do not exceed, by nearest rank. At least one
/// value.
double quantile(std::vector<double> values, double share);

}  // namespace hagfish
