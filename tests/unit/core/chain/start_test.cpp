#include "core/chain/start.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::start_test {

/// Angle (rad) or rate of hinge k.
double hinge_of(const Eigen::VectorXd& v, const Model& model, std::size_t k) {
  return v[v.size() - static_cast<Eigen::Index>(model.hinges.size() - k)];
}

TEST(Start, SaysNothingMeansStraightAndAtRest) {
  const Model fish = table1_hagfish();
  const State state = start_state(fish, {});
  EXPECT_EQ(state.q, rest_state(fish).q);
  EXPECT_EQ(state.qdot, rest_state(fish).qdot);
}

TEST(Start, EachHingeTakesTheShareOfTheBodyThatItStandsFor) {
  const Model fish = table1_hagfish();
  StartSettings settings;
  settings.bend = {{0, 0.001, 0, 0.1}, {0.5, 0.001, 0.2, 0.1}};  // constant beyond 0.5
  settings.bend_rate = {{0.5, 0, 0, 0}, {1, 3, 0, 0}};
  const State state = start_state(fish, settings);
  for (std::size_t k = 0; k < fish.hinges.size(); ++k) {
    const Hinge& hinge = fish.hinges[k];
    const double station = hinge.body / 100.0;
    // cm; the first and the last of the 49 twists take half a body more, to the ends.
    const double span = (hinge.body == 2 || hinge.body == 98 ? 3 : 2) * 42.4 / 100;
    const double angle = hinge.axis == Axis::x   ? 0.001 * span
                         : hinge.axis == Axis::y ? 0.2 * span * std::min(2 * station, 1.0)
                                                 : 0.1 * span;
    // A handful of roundings of numbers below 3.
    EXPECT_NEAR(hinge_of(state.q, fish, k), angle, 1e-15) << k;
    const double rate = hinge.axis == Axis::x ? 3 * span * std::max(0.0, 2 * station - 1) : 0;
    EXPECT_NEAR(hinge_of(state.qdot, fish, k), rate, 1e-14) << k;
  }
}

TEST(Start, BendsStopAtTheLimits) {
  const Model fish = table1_hagfish();
  StartSettings settings;
  settings.bend = {{0, 100, -100, 100}};
  const State state = start_state(fish, settings);
  for (std::size_t k = 0; k < fish.hinges.size(); ++k) {
    const Hinge& hinge = fish.hinges[k];
    EXPECT_EQ(hinge_of(state.q, fish, k), hinge.axis == Axis::y ? hinge.lower : hinge.upper) << k;
  }
}

TEST(Start, AGivenStateIsTakenAsItIs) {
  const Model fish = table1_hagfish();
  const StoredState stored = stored_state("slide");
  StartSettings settings;
  settings.q.assign(stored.state.q.begin(), stored.state.q.end());
  settings.qdot.assign(stored.state.qdot.begin(), stored.state.qdot.end());
  settings.q[3] *= 2;  // all but a unit quaternion
  const State state = start_state(fish, settings);
  const Eigen::Index hinges = fish.nq() - 7;
  EXPECT_EQ(state.q.tail(hinges), stored.state.q.tail(hinges));
  EXPECT_EQ(state.qdot, stored.state.qdot);
  EXPECT_NEAR(state.q.segment<4>(3).norm(), 1, 1e-15);  // one rounding
}

TEST(Start, NoiseIsNormalSeededAndWithinLimits) {
  const Model fish = table1_hagfish(400);
  StartSettings settings;
  settings.noise = 0.01;
  const State state = start_state(fish, settings);
  double squares = 0;
  int count = 0;
  for (std::size_t k = 0; k < fish.hinges.size(); ++k) {
    const double angle = hinge_of(state.q, fish, k);
    EXPECT_LE(std::abs(angle), fish.hinges[k].upper) << k;
    if (fish.hinges[k].upper > 5 * settings.noise) {
      squares += angle * angle;
      ++count;
    }
  }
  // A variance from n = 400 normal numbers is off by sqrt(2 / n), 7 %: three times that.
  EXPECT_NEAR(squares / count, 1e-4, 0.21e-4);
  EXPECT_EQ(state.q, start_state(fish, settings).q);
  settings.seed = 2;
  EXPECT_NE(state.q, start_state(fish, settings).q);
}

}  // namespace hagfish::start_test
