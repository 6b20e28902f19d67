// The rest shape that a curvature program and muscle tone give, and the torques towards it.
#include "core/muscle/active_curvature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_chain.hpp"

namespace hagfish::active_curvature_test {

// Products and sums of a few numbers of one size.
constexpr double rounding = 1e-13;

/// `value` everywhere and always, rad per body length.
CurvatureProgram even(const Eigen::Vector3d& value) {
  const Eigen::Matrix3Xd at = value.replicate(1, 2);
  return {{0, 1}, {0, 1}, {at, at}, {}};
}

/// Sum of the hinges' angles about each axis, x y z.
Eigen::Vector3d total(const Model& model, const Eigen::VectorXd& shape) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    sum[static_cast<int>(model.hinges[k].axis)] += shape[root_dofs + static_cast<int>(k)];
  }
  return sum;
}

class ActiveCurvature : public testing::Test {
 protected:
  ActiveCurvature() {
    scene.script.kind = ScriptSettings::Kind::curvature;
    scene.script.curvature = even({2, 3, 0.5});
    scene.active = {2e5, 0.1, 0.5, 1e9};
    scene.time.step = 0.005;
  }
  Scene scene = table1_scene();
  Model model = table1_hagfish();
};

TEST_F(ActiveCurvature, ABodyBendsByItsCurvatureWhateverItsLengthAndBodies) {
  for (const int bodies : {60, 100, 101, 200}) {
    for (const double length : {25.0, 42.4, 60.0}) {
      Specimen specimen = table1_specimen();
      specimen.length = length;
      const Model other = make_hagfish(specimen, table1_scene(bodies));
      // The spans of the hinges of one axis add up to the whole body: rounding.
      const Eigen::Vector3d sum = total(other, program_shape(other, even({2, 3, 0.5}), 0.3));
      EXPECT_LT((sum - Eigen::Vector3d(0.5, 2, 3)).norm(), rounding) << bodies << " bodies";
    }
  }
}

TEST_F(ActiveCurvature, IsLinearBetweenTimesAndStationsAndConstantOutside) {
  CurvatureProgram program{{0, 1, 3}, {0.1, 0.6, 0.9}, {}, {}};
  Random random(1);
  for (int k = 0; k < 3; ++k) {
    program.value.emplace_back(Eigen::Matrix3Xd::Zero(3, 3));
    for (double& x : program.value.back().reshaped()) x = uniform(random, -1, 1);
  }
  const auto value = [&](double time, double station, int row) {
    // Written out anew: the hat functions of each knot.
    const auto hat = [](const std::vector<double>& knots, std::size_t k, double x) {
      const double at = std::clamp(x, knots.front(), knots.back());
      if (k > 0 && at < knots[k]) {
        return std::max(0.0, (at - knots[k - 1]) / (knots[k] - knots[k - 1]));
      }
      if (k + 1 < knots.size() && at > knots[k]) {
        return std::max(0.0, (knots[k + 1] - at) / (knots[k + 1] - knots[k]));
      }
      return 1.0;
    };
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        sum += hat(program.time, i, time) * hat(program.station, j, station) *
               program.value[i](row, static_cast<int>(j));
      }
    }
    return sum;
  };
  for (const double time : {-1.0, 0.0, 0.4, 1.0, 2.5, 3.0, 7.0}) {
    const Eigen::VectorXd shape = program_shape(model, program, time);
    EXPECT_TRUE(shape.head<root_dofs>().isZero(0));
    for (std::size_t k = 0; k < model.hinges.size(); ++k) {
      const Hinge& hinge = model.hinges[k];
      const int row = hinge.axis == Axis::y ? 0 : hinge.axis == Axis::z ? 1 : 2;
      const double share = hinge_span(model, hinge.body) / 42.4;
      EXPECT_NEAR(shape[root_dofs + static_cast<int>(k)],
                  share * value(time, hinge.body / 100.0, row), rounding);
    }
  }
}

TEST_F(ActiveCurvature, NoiseComesOnTop) {
  CurvatureProgram program = even({2, 3, 0.5});
  program.noise = even({0.1, -0.2, 0.3}).value;
  const Eigen::VectorXd wanted = program_shape(model, even({2.1, 2.8, 0.8}), 0.2);
  EXPECT_LT((program_shape(model, program, 0.2) - wanted).norm(), rounding);
}

TEST_F(ActiveCurvature, TheRestShapeIsTheProgramThenFollowsTheBodyThenStraightens) {
  const Eigen::VectorXd q = bent_state(model, 0.02, 0.05, 0.01).q;
  const auto angles = q.tail(model.nv() - root_dofs);
  Eigen::VectorXd rest;
  move_rest_shape(model, scene, Phase::form, q, 0.1, rest);
  // Of the step's end, to which the torque is implicit.
  EXPECT_EQ(rest, program_shape(model, scene.script.curvature, 0.105));
  const Eigen::VectorXd tied = rest;
  for (int k = 0; k < 20; ++k) move_rest_shape(model, scene, Phase::slide, q, 0.1, rest);
  EXPECT_TRUE(rest.head<root_dofs>().isZero(0));
  const auto lag = [&](const Eigen::VectorXd& shape) {
    return (shape.tail(angles.size()) - angles).eval();
  };
  // 20 steps of 5 ms are one tone_time.
  EXPECT_LT((lag(rest) - std::exp(-1) * lag(tied)).norm(), rounding);
  const Eigen::VectorXd held = rest;
  for (int k = 0; k < 100; ++k) {
    move_rest_shape(model, scene, k < 50 ? Phase::release : Phase::free, q, 0.1, rest);
  }
  EXPECT_LT((rest - std::exp(-1) * held).norm(), rounding);  // 0.5 s are one relax_time
}

TEST_F(ActiveCurvature, ARunThatBeginsTiedBeginsAtItsOwnShape) {
  const Eigen::VectorXd q = bent_state(model, 0.02, 0.05, 0.01).q;
  Eigen::VectorXd rest;
  move_rest_shape(model, scene, Phase::slide, q, 0.1, rest);
  EXPECT_EQ(rest.tail(model.nv() - root_dofs), q.tail(model.nv() - root_dofs));
}

TEST_F(ActiveCurvature, TorquesPullToTheRestShapeAndCarryThePassiveSpring) {
  Random random(3);
  const State state = random_state(random, model, 0.3, 2);
  const Eigen::VectorXd rest = program_shape(model, scene.script.curvature, 0);
  const ActiveTorque torque = active_torque(model, scene, state, rest);
  EXPECT_TRUE(torque.value.head<root_dofs>().isZero(0));
  EXPECT_TRUE(torque.rate.head<root_dofs>().isZero(0));
  const Eigen::VectorXd passive = stiffness_force(model, state.q);
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double stiffness = 2e5 / hinge_span(model, hinge.body);
    EXPECT_NEAR(torque.rate[k], 0.005 * stiffness, rounding * stiffness);
    // With the passive spring it is one spring about the rest shape.
    EXPECT_NEAR(torque.value[k] + passive[k],
                (stiffness + hinge.stiffness) * (rest[k] - state.q[k + 1]), rounding * stiffness);
  }
}

TEST_F(ActiveCurvature, MusclesMakeNoMoreThanTheirCapacity) {
  scene.active.capacity = 1000;
  State state = rest_state(model);
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.nv());
  rest[10] = 1;
  rest[11] = -1;
  rest[12] = 1e-4;
  state.qdot[13] = 20;  // h k_a q̇ alone is beyond
  const ActiveTorque torque = active_torque(model, scene, state, rest);
  EXPECT_EQ(torque.value[10], 1000);
  EXPECT_EQ(torque.value[11], -1000);
  EXPECT_EQ(torque.value[13], -1000);
  for (const int k : {10, 11, 13}) EXPECT_EQ(torque.rate[k], 0);
  EXPECT_GT(torque.value[12], 0);
  EXPECT_LT(torque.value[12], 1000);
  EXPECT_GT(torque.rate[12], 0);
}

}  // namespace hagfish::active_curvature_test
