#include "experiments/judge/expectations.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace hagfish::expectations_test {

/// Bounds that are all different.
ExpectSettings expected() {
  ExpectSettings expect;
  expect.penetration = 0.25;
  expect.overlap = 0.75;
  expect.limit_violation = std::numbers::pi / 4;
  expect.head_drift = 0.125;
  expect.kkt = 0.5;
  expect.energy_gain = 0.0625;
  expect.speed_share = 0.75;
  expect.pull = 0.3125;
  expect.pull_drift = 0.4;
  expect.pull_balance = 0.03125;
  return expect;
}

// A figure at its bound is met, and one beyond it is not.
TEST(Expectations, HoldEachFigureAgainstItsOwnBound) {
  const ExpectSettings e = expected();
  Scene hard, soft;
  hard.expect = soft.expect = e;
  soft.flesh.stiffness = 1;
  for (const auto& [at, beyond] :
       {std::pair{penetration_criterion(hard, 0.25), penetration_criterion(hard, 0.2501)},
        {penetration_criterion(soft, 0.75), penetration_criterion(soft, 0.7501)},
        {limits_criterion(e, std::numbers::pi / 4), limits_criterion(e, 0.8)},
        {head_drift_criterion(e, 0.125), head_drift_criterion(e, 0.1251)},
        {kkt_criterion(e, 0.5), kkt_criterion(e, 0.51)},
        {energy_gain_criterion(e, 0.0625), energy_gain_criterion(e, 0.0626)},
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
  e.speed_share = 0;
  EXPECT_FALSE(eq6_criterion(e, 0, 0).met());
  Scene scene;
  scene.expect = e;
  EXPECT_FALSE(penetration_criterion(scene, NAN).met());
  EXPECT_FALSE(pull_balance_criterion(e, 0, 0).met());
}

/// A slide that keeps to what taper asks, but for `trailing`.
Slide slid(double from, double leading, double trailing) {
  return {.from = from,
          .leading_way = leading,
          .trailing_way = trailing,
          .taper_asks = 8,
          .travel = 8,
          .correlation = 1};
}

std::vector<bool> met(const std::vector<Criterion>& criteria) {
  std::vector<bool> all;
  for (const Criterion& one : criteria) all.push_back(one.met());
  return all;
}

// The leading end is asked for its distance or, from nearer, for all the way to its release.
TEST(Expectations, ASlideIsAskedForItsWayAndForBothEnds) {
  using Met = std::vector<bool>;
  Scene scene;
  scene.expect.slide_distance = 9;
  scene.expect.reverse_distance = 11;
  scene.expect.slide_share = 0.75;
  scene.controller.release_at = 2;
  EXPECT_EQ(met(slide_criteria(scene, slid(12, 9, 6))), (Met{true, true}));
  EXPECT_EQ(met(slide_criteria(scene, slid(12, 8.99, 6))), (Met{false, true}));
  EXPECT_EQ(met(slide_criteria(scene, slid(12, 9, 5.99))), (Met{true, false}));
  EXPECT_EQ(met(slide_criteria(scene, slid(8, 5.8, 6))), (Met{true, true}));
  EXPECT_EQ(met(slide_criteria(scene, slid(5, 2.8, 6))), (Met{false, true}));
  EXPECT_EQ(met(slide_criteria(scene, slid(5, 2.8, 6), false)), (Met{true, true}));
  EXPECT_EQ(met(way_back_criteria(scene, slid(12, 11, 6))), (Met{true, true}));
  EXPECT_EQ(met(way_back_criteria(scene, slid(12, 10.99, 5.99))), (Met{false, false}));
  scene.expect = {};
  EXPECT_EQ(met(slide_criteria(scene, {})), (Met{false, false}));  // there was none
  EXPECT_EQ(met(way_back_criteria(scene, {})), (Met{false, false}));
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
