// The part of a check that makes a log's run again.
#pragma once

#include "core/log/reading/log_contents.hpp"
#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Makes the run of a log again and compares all that the log holds, but for how long a computer
/// took and what tells when, where and by which command it was made (compare_logs.hpp). Of a law of
/// the run's own, and of a branch whose beginning the log does not have, it says that it was not
/// made again. Fails where it cannot be.
Finding audit_again(const LogContents& log);

}  // namespace hagfish
