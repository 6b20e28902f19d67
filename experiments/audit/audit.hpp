// Audits a log from outside: topology, penetration, limits, drift, residuals, forces, energy. What
// can be recomputed from q, q̇ and the forces is, with the model that the log's own scene makes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/audit/expectations.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// What was judged, in figures and in words. Figures are numbers, or words where it is those that
/// are compared; empty where the log has none.
struct Finding {
  std::string name;    ///< what was judged, in a word or two
  bool passed = true;  ///< false fails the log
  std::string text;    ///< the figure and its bound, in one line
  std::string value, bound, unit;
};

/// A finding on a figure, described by `text`.
Finding judged(const Criterion& criterion, const std::string& text);

/// The same, described as "VALUE UNIT, SCOPE (at most BOUND)".
Finding judged_over(const Criterion& criterion, const std::string& scope = "");

/// So many of so many: all must be, and there must be some.
Finding all_of(const std::string& name, std::int64_t count, std::int64_t of,
               const std::string& unit, const std::string& text);

/// All findings on one log, in the order of its groups. Throws FileError or InputError where it is
/// not a log of this format and version, or a dataset is missing.
std::vector<Finding> audit(const LogContents& log);
std::vector<Finding> audit(const std::string& file);

}  // namespace hagfish
