// Audits a log from outside: topology, penetration, limits, drift, residuals, forces, energy. What
// can be recomputed from q, q̇ and the forces is, with the model that the log's own scene makes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/judge/expectations.hpp"

namespace hagfish {

/// All findings on one log, in the order of its groups. Throws FileError or InputError where it is
/// not a log of this format and version, or a dataset is missing.
std::vector<Finding> audit(const LogContents& log);
std::vector<Finding> audit(const std::string& file);

}  // namespace hagfish
