// The part of an audit that is about the knot: its type through time, its hand, how it slid.
#pragma once

#include <vector>

#include "experiments/audit.hpp"

namespace hagfish {

/// Findings against the scene's [expect]; none where the scene expects no knot. What a run that
/// stops early (time.until) does not reach is not judged.
std::vector<Finding> audit_knot(const LogContents& log);

}  // namespace hagfish
