#include "experiments/audit/expectations.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace hagfish::expectations_test {

/// Bounds that are all different.
ExpectSettings expected() {
  ExpectSettings expect;
  expect.penetration = 0.25;
  expect.limit_violation = std::numbers::pi / 4;
  expect.head_drift = 0.125;
  expect.kkt = 0.5;
  expect.energy_gain = 0.0625;
  expect.slide_distance = 9;
  expect.reverse_distance = 11;
  expect.speed_share = 0.75;
  expect.pull = 0.3125;
  expect.pull_drift = 0.4;
  expect.pull_balance = 0.03125;
  return expect;
}

// A figure at its bound is met, and one beyond it is not.
TEST(Expectations, HoldEachFigureAgainstItsOwnBound) {
  const ExpectSettings e = expected();
  for (const auto& [at, beyond] :
       {std::pair{penetration_criterion(e, 0.25), penetration_criterion(e, 0.2501)},
        {limits_criterion(e, std::numbers::pi / 4), limits_criterion(e, 0.8)},
        {head_drift_criterion(e, 0.125), head_drift_criterion(e, 0.1251)},
        {kkt_criterion(e, 0.5), kkt_criterion(e, 0.51)},
        {energy_gain_criterion(e, 0.0625), energy_gain_criterion(e, 0.0626)},
        {slide_criterion(e, 9), slide_criterion(e, 8.99)},
        {reverse_criterion(e, 11), reverse_criterion(e, 10.99)},
        {pull_criterion(e, 31250), pull_criterion(e, 31249)},
        {pull_drift_criterion(e, 80, 120), pull_drift_criterion(e, 120.1, 80)},
        {pull_balance_criterion(e, 33, 32), pull_balance_criterion(e, 30.9, 32)},
        {eq6_criterion(e, 3, 4), eq6_criterion(e, 29, 40)}}) {
    EXPECT_TRUE(at.met()) << at.name;
    EXPECT_DOUBLE_EQ(at.value, at.bound) << at.name;
    EXPECT_FALSE(beyond.met()) << beyond.name;
  }
}

TEST(Expectations, WhatDidNotHappenIsNotMet) {
  ExpectSettings e = expected();
  e.slide_distance = e.reverse_distance = e.speed_share = 0;
  EXPECT_FALSE(slide_criterion(e, std::nullopt).met());
  EXPECT_FALSE(reverse_criterion(e, std::nullopt).met());
  EXPECT_FALSE(eq6_criterion(e, 0, 0).met());
  EXPECT_FALSE(penetration_criterion(e, NAN).met());
  EXPECT_FALSE(pull_balance_criterion(e, 0, 0).met());
}

TEST(EnergyGainTest, IsWhatExceedsStartAndInput) {
  EnergyGain gain(100);
  gain.see(140, 50);  // 10 were lost
  EXPECT_EQ(gain.largest(), 0);
  gain.see(153, 50);  // 3 of 150
  EXPECT_DOUBLE_EQ(gain.largest(), 3.0 / 150);
  gain.see(102, 0);  // 2 of the most that there was, 150
  EXPECT_DOUBLE_EQ(gain.largest(), 3.0 / 150);
  gain.see(NAN, 0);
  EXPECT_EQ(gain.largest(), INFINITY);
}

TEST(EnergyGainTest, NeedsEnergyToBeAShareOf) {
  EnergyGain gain(0);
  gain.see(1, 0);
  EXPECT_EQ(gain.largest(), 0);
  gain.see(3, 2);  // 1 of 2
  EXPECT_DOUBLE_EQ(gain.largest(), 0.5);
}

}  // namespace hagfish::expectations_test
