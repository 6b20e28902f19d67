// The part of an audit that asks whether a log holds all that a log must hold.
#pragma once

#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// Logs made before a dataset was added can be read, but not audited: what is not there cannot be
/// checked. Throws FileError naming the first dataset that is missing or does not have the shape
/// that its model, frames, steps and contacts give it, or an attribute `unit` or `description`.
void check_datasets(const LogContents& log);

}  // namespace hagfish
