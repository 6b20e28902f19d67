// The part of an audit that judges the pull at food: its figures, how steady it is, what it rests
// on and when it ends.
#pragma once

#include <vector>

#include "experiments/audit/audit.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// Every log's /pull; the rest where the scene has food and the run reaches it.
std::vector<Finding> audit_pull(const LogContents& log);

}  // namespace hagfish
