#include "core/chain/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hagfish::lanes_test {

TEST(Lanes, HaveTheRootsOfTheirNumbers) {
  // Eigen's root of many numbers at once is not the processor's: good to two units in the last
  // place.
  LaneValues values;
  for (int trial = 0; trial < 1000; ++trial) {
    for (int k = 0; k < lane_count; ++k) {
      values[k] = std::pow(10.0, (trial * lane_count + k) % 37 - 18) * (1 + 0.001 * trial);
    }
    const Lanes roots = root(lanes_of(values));
    for (int k = 0; k < lane_count; ++k) {
      EXPECT_NEAR(roots[k], std::sqrt(values[k]), 5e-16 * std::sqrt(values[k]));
    }
  }
  EXPECT_EQ(root(Lanes{})[0], 0);
}

TEST(Lanes, DoNotMix) {
  for (int k = 0; k < lane_count; ++k) {
    LaneValues values{};
    values[k] = 3;
    const Lanes one = lanes_of(values);
    EXPECT_TRUE(any(one > lanes_of(2)));
    EXPECT_FALSE(any(one > lanes_of(3)));
    const Lanes low = least(one, lanes_of(1));
    const Lanes size = magnitude(-one);
    for (int i = 0; i < lane_count; ++i) {
      EXPECT_EQ(low[i], i == k ? 1 : 0);
      EXPECT_EQ(size[i], i == k ? 3 : 0);
    }
  }
}

}  // namespace hagfish::lanes_test
