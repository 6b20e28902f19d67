// The part of an audit that goes on from the log's checkpoints.
#pragma once

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Whether an earlier version of the program made the log, whose checkpoints this one cannot read.
bool is_of_earlier_version(const LogContents& log);

/// From each checkpoint the run is taken on to the next frame, and from the last but one to where
/// the log ends: it must come by the states that were logged. Throws FileError where a checkpoint
/// does not fit the log. Those of an earlier version are not followed.
Finding audit_checkpoints(const LogContents& log);

}  // namespace hagfish
