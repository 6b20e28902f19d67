#include "core/chain/state.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_chain.hpp"

namespace hagfish::state_test {

TEST(State, AdvanceMovesCoordinatesByTheirVelocities) {
  Random random(11);
  const Model model = random_chain(random, 6);
  const State state = random_state(random, model);
  const double h = 0.37;
  const Eigen::VectorXd q = advance(state.q, state.qdot, h);
  EXPECT_EQ(q.head<3>(), state.q.head<3>() + h * state.qdot.head<3>());
  const Eigen::Index hinges = model.nv() - root_dofs;
  EXPECT_EQ(q.tail(hinges), state.q.tail(hinges) + h * state.qdot.tail(hinges));
}

TEST(State, AdvanceKeepsTheQuaternionUnit) {
  // A normalisation ends in a rounding of each component: 4 machine epsilons at most, whatever the
  // number of steps.
  Random random(12);
  const Model model = random_chain(random, 2);
  State state = random_state(random, model, 0.5, 300);
  for (int step = 0; step < 20000; ++step) {
    state.q = advance(state.q, state.qdot, 1e-3);
    ASSERT_NEAR(state.q.segment<4>(3).norm(), 1, 1e-15) << step;
  }
}

TEST(State, ConstantBodyRateTurnsExactly) {
  // The rotation by a constant body rate is exp([ω] t) on the right; 1000 products of rotations,
  // each rounded.
  Random random(13);
  const Model model = random_chain(random, 1);
  for (int trial = 0; trial < 20; ++trial) {
    State state = random_state(random, model, 0, 10);
    const Eigen::Vector3d rate = state.qdot.segment<3>(3);
    const Eigen::Matrix3d expected =
        root_orientation(state.q).toRotationMatrix() *
        Eigen::AngleAxisd(2.5 * rate.norm(), rate.normalized()).toRotationMatrix();
    const Eigen::VectorXd at_once = advance(state.q, state.qdot, 2.5);
    EXPECT_LT(relative_error(root_orientation(at_once).toRotationMatrix(), expected), 1e-14);
    for (int step = 0; step < 1000; ++step) {
      state.q = advance(state.q, state.qdot, 2.5e-3);
    }
    EXPECT_LT(relative_error(root_orientation(state.q).toRotationMatrix(), expected), 1e-12);
  }
}

}  // namespace hagfish::state_test
