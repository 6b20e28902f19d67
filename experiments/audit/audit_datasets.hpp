// The part of an audit that asks whether a log holds all that a log must hold.
#pragma once

#include "experiments/audit/audit.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// Logs made before a dataset was added can be read, but not audited: what is not there cannot be
/// checked. Throws FileError naming the first dataset that is missing or does not have the shape
/// that its model, frames, steps and contacts give it, or an attribute `unit` or `description`.
/// Of a log of this revision also one whose words, axis labels or enumeration are not the
/// program's.
void check_datasets(const LogContents& log);

/// Names each dataset and attribute that is not as the log's seal says. A log without a seal passes
/// where its run has not ended or another revision made it.
Finding audit_seal(const LogContents& log);

}  // namespace hagfish
