// The muscles in MuJoCo: tendons and actuators that make the torques of the core's, state by state.
#include <gtest/gtest.h>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/muscle/paths.hpp"
#include "mujoco_ref/agreement.hpp"
#include "mujoco_ref/mirror.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::mjcf_muscles_test {

/// Torques of up to 3e5 dyn cm, from arms that both programs know to 1e-13 of the body's length.
constexpr double torque_tolerance = 1e-8;  // of the largest

class MjcfMuscles : public testing::TestWithParam<Head> {};

TEST_P(MjcfMuscles, MakeTheTorquesOfTheCore) {
  const Model model = muscled_hagfish();
  MujocoModel mirror(mjcf_files(model, 2.968, 0.002, GetParam()));
  const int n = mirror.model()->nv;
  ASSERT_EQ(mirror.model()->nu, static_cast<int>(model.muscles.size()));
  mirror.model()->opt.disableflags |= mjDSBL_CONSTRAINT;
  Random random(1);
  for (int draw = 0; draw < 100; ++draw) {
    const State state = drawn_state(random, model, GetParam(), 1, 10);
    Eigen::VectorXd activation(model.muscles.size());
    for (double& a : activation) a = uniform(random, 0, 1);
    set_state(model, state, mirror);
    std::ranges::copy(activation, mirror.data()->ctrl);
    mj_forward(mirror.model(), mirror.data());
    const Kinematics kin = kinematics(model, state);
    Eigen::VectorXd torque;
    muscle_torque(model, kin, activation, torque);
    const Eigen::Map<const Eigen::VectorXd> mujoco(mirror.data()->qfrc_actuator, n);
    EXPECT_LE((mujoco - torque.tail(n)).lpNorm<Eigen::Infinity>(),
              torque_tolerance * torque.lpNorm<Eigen::Infinity>());
    for (int m = 0; m < mirror.model()->nu; ++m) {
      ASSERT_EQ(mj_id2name(mirror.model(), mjOBJ_ACTUATOR, m), model.muscles[m].name);
      ASSERT_NEAR(mirror.data()->ten_length[m], muscle_length(kin, model.muscles[m]), 1e-11);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Heads, MjcfMuscles, testing::Values(Head::free, Head::clamped),
                         [](const auto& head) {
                           return head.param == Head::free ? "free" : "clamped";
                         });

}  // namespace hagfish::mjcf_muscles_test
