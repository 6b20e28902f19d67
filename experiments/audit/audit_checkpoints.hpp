// The part of an audit that goes on from the log's checkpoints.
#pragma once

#include "experiments/audit/audit.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// Whether an earlier version of the program made the log, whose checkpoints this one cannot read.
bool is_of_earlier_version(const LogContents& log);

/// Whether this build made the log, on a machine of this kind: then its run comes again bit by bit.
bool is_of_this_build(const Hdf5Reader& h5);

/// Whether a run of the log's scene from its start must make all of the log, bit by bit, and with
/// it each checkpoint: of this build, in one go and by a law that is not its own.
bool comes_again(const LogContents& log);

/// Each checkpoint that time.checkpoint_interval asks for must be there, and lead to the next one,
/// the last one to where the log ends, by the states of all frames between: bit by bit in all that
/// they hold but the texts of warnings, where this build made the log. Else the run is taken on to
/// the next frame, and must come by the states that were logged. Throws FileError where a
/// checkpoint does not fit the log. Those of an earlier version are not followed.
Finding audit_checkpoints(const LogContents& log);

}  // namespace hagfish
