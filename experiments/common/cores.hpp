// How many threads a command starts by itself, and jobs for them.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hagfish {

/// The cores that this process may use: those of its affinity, and no more than the CPU quota of
/// its container or control group, at least 1. `quota_file`: "QUOTA PERIOD" of Linux's cgroup v2,
/// in µs; "max" or no such file means no quota.
int usable_cores(const std::string& quota_file = "/sys/fs/cgroup/cpu.max");

/// work(k) for k from 0 to count - 1, each once, by so many threads. What one of them throws ends
/// all of them after the job at hand, and is thrown.
template <class Work>
void in_parallel(int count, int threads, const Work& work) {
  std::atomic<int> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  {
    std::vector<std::jthread> workers;
    for (int t = 0; t < std::min(count, threads); ++t) {
      workers.emplace_back([&] {
        try {
          for (int k = next++; k < count; k = next++) work(k);
        } catch (...) {
          const std::scoped_lock lock(mutex);
          if (!error) error = std::current_exception();
          next = count;
        }
      });
    }
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace hagfish
