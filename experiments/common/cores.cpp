#include "experiments/common/cores.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

namespace hagfish {

int usable_cores(const std::string& quota_file) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  double quota = 0, period = 0;
  if (!(std::ifstream(quota_file) >> quota >> period) || period <= 0) return cores;
  return std::clamp(static_cast<int>(std::ceil(quota / period)), 1, cores);
}

}  // namespace hagfish
