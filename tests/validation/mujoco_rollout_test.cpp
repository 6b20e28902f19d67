// Motion of the chain alone in two programs: by the same rule to rounding, and by the core's rule
// against MuJoCo's fourth-order one at first order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/step/step.hpp"
#include "mujoco_ref/agreement.hpp"
#include "mujoco_ref/mirror.hpp"
#include "mujoco_ref/rollout.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::mujoco_rollout_test {

struct Case {
  int bodies;
  Head head;
  double damping;  ///< dyn cm^2 s
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return std::to_string(info.param.bodies) +
         (info.param.head == Head::free ? "_free" : "_clamped") +
         (info.param.damping > 0 ? "_damped" : "_undamped");
}

Model moving_hagfish(int bodies, double damping) {
  Scene scene = table1_scene(bodies);
  scene.model.bending_damping = damping;
  scene.model.twist_damping = damping;
  return smooth(make_hagfish(table1_specimen(), scene));
}

MujocoModel mirror_of(const Model& model, double h, Head head) {
  return MujocoModel(mjcf_files(model, 0, h, head));
}

class MujocoRollout : public testing::TestWithParam<Case> {};

TEST_P(MujocoRollout, MovesAlikeForOneSecond) {
  const auto& [bodies, head, damping] = GetParam();
  constexpr double h = 0.002;
  constexpr int steps = 500;
  const Model model = moving_hagfish(bodies, damping);
  std::mt19937 random(1);
  const State start = drawn_state(random, model, head, 0.1, 0.5);
  MujocoModel mirror = mirror_of(model, h, head);
  use_core_rule(mirror);
  const std::vector<State> core = core_rollout(model, start, head, TimeRule::euler, h, steps);
  const std::vector<State> mujoco = mujoco_rollout(model, start, mirror, steps);
  double largest = 0;
  for (int i = 0; i < steps; ++i) {
    largest = std::max(largest, velocity_difference(core[i], mujoco[i]));
  }
  // Rounding, carried along for 500 steps by a motion that is not chaotic yet. Seen: 1e-10.
  EXPECT_LE(largest, 1e-8);
  EXPECT_GT(centre_distance(model, start, core.back()), 0.1) << "it must have moved, cm";
}

INSTANTIATE_TEST_SUITE_P(Hagfish, MujocoRollout,
                         testing::Values(Case{2, Head::free, 10}, Case{2, Head::clamped, 10},
                                         Case{3, Head::free, 10}, Case{3, Head::clamped, 10},
                                         Case{10, Head::free, 10}, Case{10, Head::clamped, 10},
                                         Case{50, Head::free, 10}, Case{50, Head::clamped, 10},
                                         Case{100, Head::free, 10}, Case{100, Head::clamped, 10},
                                         Case{10, Head::free, 0}, Case{10, Head::clamped, 0}),
                         name_of);

class MujocoRk4 : public testing::TestWithParam<Head> {};

/// Observed orders of the core's error against MuJoCo's RK4, of halvings from 2 to 1 to 0.5 ms.
std::array<double, 2> orders(Head head, TimeRule rule) {
  constexpr double time = 0.5;
  const Model model = moving_hagfish(25, 10);
  std::mt19937 random(3);
  const State start = drawn_state(random, model, head, 0.1, 0.5);
  // Fourth order: at 0.5 ms its own error is some 1e-6 of the core's.
  MujocoModel mirror = mirror_of(model, 0.0005, head);
  mirror.model()->opt.integrator = mjINT_RK4;
  const State reference = mujoco_rollout(model, start, mirror, 1000).back();
  const auto error = [&](double h) {
    const int steps = static_cast<int>(std::lround(time / h));
    return centre_distance(model, core_rollout(model, start, head, rule, h, steps).back(),
                           reference);
  };
  const double middle = error(0.001);
  return {std::log2(error(0.002) / middle), std::log2(middle / error(0.0005))};
}

// But for the next term of the series, which halves with each halving of the step.
TEST_P(MujocoRk4, IsApproachedAtFirstOrderByEuler) {
  const auto [coarse, fine] = orders(GetParam(), TimeRule::euler);
  EXPECT_NEAR(coarse, 1, 0.1);
  EXPECT_NEAR(fine, 1, 0.05);
}

TEST_P(MujocoRk4, IsApproachedAtSecondOrderByTheMidpointRule) {
  const auto [coarse, fine] = orders(GetParam(), TimeRule::midpoint);
  // Passes stop at time.settled, which takes a share of the coarser errors: 2.0 to 2.25 seen.
  EXPECT_GT(std::min(coarse, fine), 1.9);
  EXPECT_LT(std::max(coarse, fine), 2.4);
}

INSTANTIATE_TEST_SUITE_P(Hagfish, MujocoRk4, testing::Values(Head::free, Head::clamped),
                         [](const auto& test) {
                           return test.param == Head::free ? "free" : "clamped";
                         });

// MuJoCo would set the state back and go on.
TEST(MujocoRollout, SaysWhenMujocoBlowsUp) {
  const Model model = moving_hagfish(10, 0);
  std::mt19937 random(4);
  const State start = drawn_state(random, model, Head::free, 1, 1e6);
  MujocoModel mirror = mirror_of(model, 0.1, Head::free);
  EXPECT_THROW(mujoco_rollout(model, start, mirror, 100), StepError);
}

}  // namespace hagfish::mujoco_rollout_test
