// How many threads a command starts by itself.
#pragma once

#include <string>

namespace hagfish {

/// The cores that this process may use: those of its affinity, and no more than the CPU quota of
/// its container or control group, at least 1. `quota_file`: "QUOTA PERIOD" of Linux's cgroup v2,
/// in µs; "max" or no such file means no quota.
int usable_cores(const std::string& quota_file = "/sys/fs/cgroup/cpu.max");

}  // namespace hagfish
