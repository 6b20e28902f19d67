#include "core/control/script.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_chain.hpp"

namespace hagfish::script_test {

TimeSettings steps_of(double h, TimeRule rule = TimeRule::euler) {
  TimeSettings time;
  time.rule = rule;
  time.step = h;
  return time;
}

using Eigen::Vector3d;

// A handful of products of numbers of one size.
constexpr double rounding = 1e-14;

ScriptSettings script(ScriptSettings::Kind kind) {
  ScriptSettings s;
  s.kind = kind;
  s.waypoints = {{0, {1, 0, 0}}, {0.5, {2, -1, 0}}, {2, {4, 3, 1}}, {3, {0, 0, 0}}};
  s.spring = 3000;
  s.damper = 20;
  s.largest_force = 1200;
  return s;
}

const ScriptSettings force = script(ScriptSettings::Kind::force);
const ScriptSettings position = script(ScriptSettings::Kind::position);

TEST(Script, ForcesAreLinearBetweenKnots) {
  for (std::size_t k = 0; k + 1 < force.waypoints.size(); ++k) {
    const Waypoint& a = force.waypoints[k];
    const Waypoint& b = force.waypoints[k + 1];
    for (const double u : {0.0, 0.25, 0.6}) {
      const Vector3d expected = (1 - u) * a.value + u * b.value;
      EXPECT_LT((script_value(force, a.time + u * (b.time - a.time)) - expected).norm(), rounding);
    }
  }
}

TEST(Script, IsConstantOutside) {
  for (const ScriptSettings& s : {force, position}) {
    EXPECT_EQ(script_value(s, -1), s.waypoints.front().value);
    EXPECT_EQ(script_value(s, 0), s.waypoints.front().value);
    EXPECT_EQ(script_value(s, 3), s.waypoints.back().value);
    EXPECT_EQ(script_value(s, 100), s.waypoints.back().value);
  }
}

TEST(Script, PositionsPassThroughTheirKnots) {
  for (const Waypoint& knot : position.waypoints) {
    EXPECT_LT((script_value(position, knot.time) - knot.value).norm(), rounding);
  }
}

TEST(Script, PositionsAreSmoothWithCatmullRomTangents) {
  // One-sided differences: truncation is half the second derivative (some 20) times e.
  const double e = 1e-7;
  const auto slope = [&](double from, double to) -> Vector3d {
    return (script_value(position, to) - script_value(position, from)) / (to - from);
  };
  for (const std::size_t k : {1U, 2U}) {
    const double t = position.waypoints[k].time;
    const Vector3d chord = (position.waypoints[k + 1].value - position.waypoints[k - 1].value) /
                           (position.waypoints[k + 1].time - position.waypoints[k - 1].time);
    EXPECT_LT((slope(t - e, t) - chord).norm(), 1e-5) << k;
    EXPECT_LT((slope(t, t + e) - chord).norm(), 1e-5) << k;
  }
}

TEST(Script, PositionsOfEvenMotionAreEven) {
  // Catmull-Rom through time reproduces a line at one speed, whatever the spacing of the knots.
  ScriptSettings s = position;
  const Vector3d velocity(1, -2, 0.5);
  for (Waypoint& knot : s.waypoints) knot.value = knot.time * velocity;
  for (double time = 0; time <= 3; time += 0.1) {
    EXPECT_LT((script_value(s, time) - time * velocity).norm(), rounding);
  }
}

TEST(Script, NoiseMovesTheKnots) {
  for (const ScriptSettings& plain : {force, position}) {
    ScriptSettings noisy = plain;
    ScriptSettings moved = plain;
    for (std::size_t k = 0; k < plain.waypoints.size(); ++k) {
      noisy.waypoints[k].noise = Vector3d(0.1, -0.2, 0.3) * static_cast<double>(k + 1);
      moved.waypoints[k].value += noisy.waypoints[k].noise;
    }
    for (const double time : {-1.0, 0.0, 0.3, 0.5, 1.1, 2.9, 3.0, 4.0}) {
      EXPECT_EQ(script_value(noisy, time), script_value(moved, time)) << time;
    }
  }
}

TEST(ScriptForce, IsNoneWithoutAScript) {
  const TipForce tip = script_force({}, 1, steps_of(0.002), {1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(tip.value, Vector3d::Zero());
  EXPECT_EQ(tip.rate, 0);
}

// At a step's end by Euler's rule, in its middle by the other; forces by Euler's rule are those of
// now.
TEST(ScriptForce, ActsWhereTheRuleHasItsForces) {
  const double h = 0.002;
  for (const TimeRule rule : {TimeRule::euler, TimeRule::midpoint}) {
    const bool euler = rule == TimeRule::euler;
    const TimeSettings time = steps_of(h, rule);
    const TipForce pull = script_force(force, 1.1, time, {1, 2, 3}, {4, 5, 6});
    EXPECT_EQ(pull.value, script_value(force, euler ? 1.1 : 1.1 + h / 2));
    EXPECT_EQ(pull.rate, 0);
    const Vector3d at = script_value(position, 1.1) + Vector3d(0.1, 0, -0.05);
    const TipForce tip = script_force(position, 1.1, time, at, {1, 2, 0});
    // With the velocity w there the force shall be kp (target(t + ahead) - at - ahead w) - kd w.
    const Vector3d w(0.7, -0.3, 2);
    const double ahead = euler ? h : h / 2;
    const Vector3d expected =
        3000 * (script_value(position, 1.1 + ahead) - at - ahead * w) - 20 * w;
    EXPECT_LT((tip.value - tip.rate * w - expected).norm(), 1000 * rounding);
  }
}

TEST(ScriptForce, OfTheMidpointRuleDampsASpringThatWouldRing) {
  const double h = 0.002;
  const TimeSettings time = steps_of(h, TimeRule::midpoint);
  ScriptSettings stiff = position;
  stiff.spring = 1e6;
  stiff.largest_force = 1e9;
  const Vector3d at = script_value(position, 1.1) + Vector3d(0.1, 0, -0.05);
  const Vector3d v(1, 2, 0), x(0.7, -0.3, 2);
  const TipForce tip = script_force(stiff, 1.1, time, at, v);
  // What the script's own damper, at x, lacks of reach times spring acts at 2 x - v.
  const double lack = h / 2 * 1e6 - 20;
  const Vector3d expected =
      1e6 * (script_value(position, 1.1 + h / 2) - at - h / 2 * x) - 20 * x - lack * (2 * x - v);
  EXPECT_LT((tip.value - tip.rate * x - expected).norm(), 1e6 * rounding);
}

TEST(ScriptForce, SaturatesAtTheLargestForce) {
  const Vector3d far(100, 0, 0);
  const TipForce tip = script_force(position, 3, steps_of(0.002), far, Vector3d::Zero());
  EXPECT_EQ(tip.rate, 0);
  EXPECT_NEAR(tip.value.norm(), 1200, 1200 * rounding);
  EXPECT_LT((tip.value.normalized() + Vector3d::UnitX()).norm(), rounding);
  // Just below, just above: one force, whether implicit or saturated.
  for (const double reach : {0.3999, 0.4001}) {
    const TipForce near =
        script_force(position, 3, steps_of(0.002), {reach, 0, 0}, Vector3d::Zero());
    EXPECT_NEAR(near.value.norm(), 1200, 0.4);
    EXPECT_EQ(near.rate == 0, reach > 0.4);
  }
}

}  // namespace hagfish::script_test
