// What a step looks at before it solves: overlap, limit violation and drift of the clamped head.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/step/step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::observe_test {

TEST(Observe, MeasuresPenetrationAndLimitViolation) {
  const Scene scene = table1_scene();
  Model fish = table1_hagfish();
  State state = rest_state(fish);
  Observation now = observe(fish, state, scene);
  // At rest nothing overlaps: body 7, the first behind the neck, is clear of the plate.
  EXPECT_EQ(now.penetration, 0);
  EXPECT_EQ(now.limit_violation, 0);

  state.q[0] = -3;
  now = observe(fish, state, scene);
  EXPECT_NEAR(now.penetration, fish.bodies[7].radius - (7.5 * 0.424 - 3), 1e-12);
  fish.obstacles.clear();
  EXPECT_EQ(observe(fish, state, scene).penetration, 0);

  state.q[7 + 12] = fish.hinges[12].upper + 0.03;
  state.q[7 + 30] = fish.hinges[30].lower - 0.05;
  EXPECT_NEAR(observe(fish, state, scene).limit_violation, 0.05, 1e-15);

  Random random(106);
  state = knotted_state(random, fish);
  now = observe(fish, state, scene);
  EXPECT_EQ(now.penetration, std::max(0.0, -now.contact.least_gap));
}

TEST(HeadDrift, IsTheLargestOfBothEndsAndTheSide) {
  const Model fish = table1_hagfish();
  State state = rest_state(fish);
  EXPECT_EQ(head_drift(fish, kinematics(fish, state)), 0);
  state.q[1] = 0.3;
  EXPECT_NEAR(head_drift(fish, kinematics(fish, state)), 0.3, 1e-15);
  state = rest_state(fish);
  const double radius = fish.bodies[0].radius;
  state.q.segment<4>(3) << 0, 1, 0, 0;  // rolled over: both ends stay, the side moves
  EXPECT_NEAR(head_drift(fish, kinematics(fish, state)), 2 * radius, 1e-15);
  state.q.segment<4>(3) << 0, 0, 1, 0;  // turned about Y: the far end moves, the side at +Y stays
  EXPECT_NEAR(head_drift(fish, kinematics(fish, state)), 2 * 0.424, 1e-15);
}

}  // namespace hagfish::observe_test
