// The part of an audit that holds what was logged of every step against what was logged at frames.
#pragma once

#include <vector>

#include "experiments/audit/audit.hpp"

namespace hagfish {

std::vector<Finding> audit_steps(const LogContents& log);

}  // namespace hagfish
