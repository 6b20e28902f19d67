// One job beside the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace hagfish {

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
