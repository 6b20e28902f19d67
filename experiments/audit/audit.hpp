// Audits a log from outside: topology, penetration, limits, drift, residuals, forces, energy. What
// can be recomputed from q, q̇ and the forces is, with the model that the log's own scene makes.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/audit/log_contents.hpp"

namespace hagfish {

struct Finding {
  std::string name;    ///< what was judged, in a word or two
  bool passed = true;  ///< false fails the log
  std::string text;    ///< the figure and its bound, in one line
};

/// The larger; a figure that is no number is as bad as can be.
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? INFINITY : std::max(a, b);
}

/// A finding on a figure that must not pass a bound.
Finding bounded(const std::string& name, double value, double bound, const std::string& unit);

/// All findings on one log, in the order of its groups. Throws FileError or InputError where the
/// file is not a log of this format and version, or a dataset is missing.
std::vector<Finding> audit(const std::string& file);

}  // namespace hagfish
