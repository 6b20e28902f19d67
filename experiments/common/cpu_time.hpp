// What work costs the processor.
#pragma once

#include <ctime>

namespace hagfish {

/// CPU time of this process so far, all its threads together, s.
inline double cpu_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace hagfish
