#include "core/chain/kinematics.hpp"

#include <gtest/gtest.h>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::kinematics_test {

// Central differences over ±1e-5 in chains of some 10 cm that turn at up to 5 rad/s: truncation
// e² ω³ r / 6 ~ 2e-8, rounding 1e-15 / 1e-5 ~ 1e-10; against rates of 10 and more.
constexpr double step = 1e-5;
constexpr double difference_tolerance = 1e-7;

Kinematics at(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot) {
  return kinematics(model, {q, qdot});
}

/// Twist of each body about `reference` by central differences along `v`.
Matrix6Xd difference_twists(const Model& model, const State& state, const Eigen::VectorXd& v,
                            const Eigen::Vector3d& reference) {
  const Kinematics now = kinematics(model, state);
  const Kinematics after = at(model, advance(state.q, v, step), v);
  const Kinematics before = at(model, advance(state.q, v, -step), v);
  Matrix6Xd twists(6, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Matrix3d spin =
        (after.rotation[b] - before.rotation[b]) / (2 * step) * now.rotation[b].transpose();
    const Eigen::Vector3d omega(0.5 * (spin(2, 1) - spin(1, 2)), 0.5 * (spin(0, 2) - spin(2, 0)),
                                0.5 * (spin(1, 0) - spin(0, 1)));
    const Eigen::Vector3d velocity = (after.centre.col(b) - before.centre.col(b)) / (2 * step);
    twists.col(b) << omega, velocity + omega.cross(reference - now.centre.col(b));
  }
  return twists;
}

TEST(Kinematics, ReferenceIsTheMiddleBody) {
  const Model fish = table1_hagfish();
  const Kinematics kin = kinematics(fish, rest_state(fish));
  EXPECT_EQ(kin.reference, kin.centre.col(50));
  EXPECT_EQ(kin.centre_offset(50).norm(), 0);
}

TEST(Kinematics, TwistsAreRatesOfPositions) {
  Random random(23);
  for (int trial = 0; trial < 20; ++trial) {
    const Model model = random_chain(random, 12);
    const State state = random_state(random, model, 1);
    const Kinematics kin = kinematics(model, state);
    EXPECT_LT(relative_error(kin.twist, difference_twists(model, state, state.qdot, kin.reference)),
              difference_tolerance);
    EXPECT_LT(relative_error(body_twists(model, kin, state.qdot), kin.twist), 1e-14);
    const Eigen::VectorXd v = random_entries(random, model.nv());
    const Matrix6Xd expected = difference_twists(model, state, v, kin.reference);
    EXPECT_LT(relative_error(body_twists(model, kin, v), expected), difference_tolerance);
    for (int b = 0; b < model.body_count(); ++b) {
      EXPECT_LT((body_jacobian(model, kin, b) * v - expected.col(b)).lpNorm<Eigen::Infinity>(),
                10 * difference_tolerance)
          << b;
    }
  }
}

TEST(Kinematics, BiasTwistsAreRatesOfTwistsAtConstantVelocities) {
  Random random(24);
  for (int trial = 0; trial < 20; ++trial) {
    const Model model = random_chain(random, 12);
    const State state = random_state(random, model, 1);
    const Kinematics now = kinematics(model, state);
    const auto twists_about_reference = [&](double time) {
      const Kinematics kin = at(model, advance(state.q, state.qdot, time), state.qdot);
      Matrix6Xd twists = kin.twist;
      for (int b = 0; b < model.body_count(); ++b) {
        twists.col(b).tail<3>() = point_velocity(kin.twist.col(b), now.reference - kin.reference);
      }
      return twists;
    };
    const Matrix6Xd rate =
        (twists_about_reference(step) - twists_about_reference(-step)) / (2 * step);
    EXPECT_LT(relative_error(now.bias_twist, rate), difference_tolerance);
  }
}

TEST(Kinematics, GeneralisedForceIsTheTransposedJacobian) {
  Random random(25);
  for (int trial = 0; trial < 20; ++trial) {
    const Model model = random_chain(random, 12);
    const Kinematics kin = kinematics(model, random_state(random, model, 1));
    Matrix6Xd wrench(6, model.body_count());
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(model.nv());
    for (int b = 0; b < model.body_count(); ++b) {
      wrench.col(b) = random_entries(random, 6);
      expected += body_jacobian(model, kin, b).transpose() * wrench.col(b);
    }
    // Sums of 12 products of size 10.
    EXPECT_LT(relative_error(generalised_force(model, kin, wrench), expected), 1e-13);
  }
}

}  // namespace hagfish::kinematics_test
