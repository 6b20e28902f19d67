#include "core/chain/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace hagfish {
namespace {

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

/// EXPECTs the sines and cosines of the standard library, to two units in the last place.
void expect_sine_and_cosine(const LaneValues& angles) {
  constexpr double rounding = 4.5e-16;
  Lanes sine, cosine;
  sine_and_cosine(lanes_of(angles), sine, cosine);
  for (int k = 0; k < lane_count; ++k) {
    const double s = std::sin(angles[k]), c = std::cos(angles[k]);
    EXPECT_NEAR(sine[k], s, rounding * std::abs(s)) << angles[k];
    EXPECT_NEAR(cosine[k], c, rounding * std::abs(c)) << angles[k];
  }
}

TEST(Lanes, HaveTheSinesAndCosinesOfTheirNumbers) {
  std::mt19937 random(5);
  LaneValues angles;
  for (const double size : {1e-9, 0.1, 1.0, 4.0, 100.0, 1e6, 1e9}) {
    for (int trial = 0; trial < 2000; ++trial) {
      for (double& angle : angles) angle = std::uniform_real_distribution(-size, size)(random);
      expect_sine_and_cosine(angles);
    }
  }
  // Where the quarter changes, and where one of the two is 0.
  for (int eighth = -80; eighth <= 80; ++eighth) {
    const double angle = eighth * std::numbers::pi / 4;
    for (int k = 0; k < lane_count; ++k) angles[k] = angle * (1 + (k - 3) * 1e-16);
    expect_sine_and_cosine(angles);
  }
}

TEST(Lanes, OneThatIsNotFiniteHasNoSineAndSpoilsNoOther) {
  LaneValues angles;
  angles.fill(0.7);
  angles[1] = std::numeric_limits<double>::infinity();
  Lanes sine, cosine;
  sine_and_cosine(lanes_of(angles), sine, cosine);
  EXPECT_TRUE(std::isnan(sine[1]) && std::isnan(cosine[1]));
  EXPECT_EQ(sine[0], std::sin(0.7));
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

}  // namespace
}  // namespace hagfish
