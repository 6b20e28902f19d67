// Muscles as paths: moment arms against differences of lengths, and against what they are where
// the body is straight.
#include "core/muscle/paths.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_chain.hpp"

namespace hagfish::paths_test {

/// Central differences over ±1e-4 rad of lengths of 0.5 to 3 cm: truncation e² l''' / 6 ~ 1e-8 but
/// where a line of no length turns round, rounding 1e-15 / 1e-4 ~ 1e-11.
constexpr double turn = 1e-4;
constexpr double difference_tolerance = 1e-7;  // cm

TEST(MusclePaths, MomentArmsAreWhatLengthsLose) {
  Random random(1);
  for (const int bodies : {2, 25, 100}) {
    const Model model = muscled_hagfish(bodies);
    for (int draw = 0; draw < 5; ++draw) {
      const State state = random_state(random, model, 0.5);
      const Kinematics now = kinematics(model, state);
      for (const Muscle& muscle : model.muscles) {
        const Body& body = model.bodies[muscle.body];
        Eigen::VectorXd arm(body.dofs);
        moment_arms(model, now, muscle, arm);
        for (int k = 0; k < body.dofs; ++k) {
          const auto length_at = [&](double by) {
            State other = state;
            other.q[body.first_dof + 1 + k] += by;
            return muscle_length(kinematics(model, other), muscle);
          };
          EXPECT_NEAR(arm[k], -(length_at(turn) - length_at(-turn)) / (2 * turn),
                      difference_tolerance)
              << muscle.name << " of " << bodies << " bodies";
        }
      }
    }
  }
}

/// Straight, lines have the share of the radius as arm, families the sine of their fibres' angle of
/// it, but for the chord; antagonists have opposite arms, and bend or twist alone.
TEST(MusclePaths, OfAStraightBodyAreThoseOfTheSpecimen) {
  const Model model = muscled_hagfish();
  ASSERT_EQ(model.muscles.size(), 4u * 50 + 2u * 49);
  const Kinematics kin = kinematics(model, rest_state(model));
  const auto arm_of = [&](int index) {
    Eigen::VectorXd arm(model.bodies[model.muscles[index].body].dofs);
    moment_arms(model, kin, model.muscles[index], arm);
    return arm;
  };
  // Joint 31, where the circumference is 5.6 - 0.1 x 0.55 or so, and joint 32.
  const int left = 6 * 15;
  ASSERT_EQ(model.muscles[left].name, "j31_left");
  ASSERT_EQ(model.muscles[left + 4].name, "j32_right_handed");
  const double radius = 0.6 * model.bodies[31].radius;
  EXPECT_NEAR(radius, 0.53, 0.005);
  constexpr double taper = 1e-3;  // of the radius from body to body, and what follows from it
  const Eigen::Vector2d expected[] = {{0, -radius}, {0, radius}, {-radius, 0}, {radius, 0}};
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR((arm_of(left + k) - expected[k]).norm(), 0, taper) << k;
    EXPECT_EQ(muscle_group(model, left).count, 4);
  }
  // To the left is to -y: there the body comes to by turning about -z.
  State bent = rest_state(model);
  bent.q[root_dofs + 1 + model.bodies[31].first_dof + 1 - root_dofs] = -0.2;
  EXPECT_LT(kinematics(model, bent).centre(1, 99), -1);
  const double turned = 0.424 / (0.6 * model.bodies[32].radius);  // over the chord, 45 degrees
  const double reach = 0.6 * model.bodies[32].radius;
  const double chord = std::hypot(0.424, 2 * reach * std::sin(turned / 2));
  for (const int sense : {1, -1}) {
    const double arm = arm_of(left + (sense > 0 ? 4 : 5))[0];
    EXPECT_NEAR(arm, -sense * 4 * reach * reach * std::sin(turned) / chord, 4e-3);
  }
  EXPECT_EQ(muscle_group(model, left + 4).count, 2);
  EXPECT_EQ(muscle_group(model, 298).count, 0);
  // 0.5 cm^2 of 100 kPa near the station that has them.
  ASSERT_EQ(model.muscles[6 * 10].name, "j21_left");
  EXPECT_NEAR(model.muscles[6 * 10].force, 0.5e6, 5e3);
}

}  // namespace hagfish::paths_test
