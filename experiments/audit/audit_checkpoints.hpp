// The part of an audit that goes on from the log's checkpoints.
#pragma once

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// From each checkpoint the run is taken on to the next frame, and from the last but one to where
/// the log ends: it must come by the states that were logged. Throws FileError where a checkpoint
/// does not fit the log.
Finding audit_checkpoints(const LogContents& log);

}  // namespace hagfish
