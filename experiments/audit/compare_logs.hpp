// A log beside another one of the same run, as of its run made again.
#pragma once

#include <string>
#include <vector>

#include "experiments/audit/audit.hpp"

namespace hagfish {

struct LogComparison {
  std::vector<std::string> differences;  ///< the earliest first, a line each
  std::string reach;                     ///< how far the two are the same, in words
};

/// Compares a log with `again`, its run made once more: all that it holds, with units, words and
/// labels, but for how long a computer took. What the same build made (`own_build`) must be the
/// same to the bit, and so must all be whose motion ends with the same bits. Else numbers are
/// compared to a tolerance, until the motions are apart by more than rounding.
LogComparison compare_logs(const LogContents& log, const std::string& again, bool own_build);

/// Makes the run of a log again and compares all that the log holds, but for how long a computer
/// took and what tells when, where and by which command it was made. Of a law of the run's own, and
/// of a branch whose beginning the log does not have, it says that it was not made again. Fails
/// where it cannot be.
Finding audit_again(const LogContents& log);

}  // namespace hagfish
