// Random numbers of the search: the same on every platform, and of each try its own, so that tries
// do not depend on who made the ones before, or when.
#pragma once

#include <random>

#include "core/scene/normal_draw.hpp"

namespace hagfish {

class Draw {
 public:
  Draw(unsigned seed, unsigned number) {
    std::seed_seq both{seed, number};
    random_.seed(both);
  }
  double uniform(double from, double to) {
    return from + (to - from) * (static_cast<double>(random_()) + 0.5) * 0x1p-32;
  }
  /// A whole number from 0 to count - 1.
  int below(int count) { return static_cast<int>(uniform(0, count)); }
  bool chance(double share) { return uniform(0, 1) < share; }
  double normal() { return normal_draw(random_); }

 private:
  std::mt19937 random_;
};

}  // namespace hagfish
