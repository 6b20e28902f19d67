// A step solves the least problem that its rows ask for, to the optimum of the paper's Eq. 4.
#include "core/step/step.hpp"

#include <gtest/gtest.h>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/step_stage.hpp"

namespace hagfish::step_test {

TEST(Step, IsLinearWhereNoRowCanBind) {
  Stage s;
  s.state.q[0] = 100;  // far from the head plate
  s.control.clamp_head = false;
  s.control.tip.value << 0, 1, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::linear);
  EXPECT_TRUE(step.rows.empty());
  EXPECT_EQ(step.rounds, 0);
  EXPECT_EQ(step.qdot, s.solver.problem().base);
  const Kinematics kin = kinematics(s.model, s.state);
  const Eigen::VectorXd g = generalised_force(s.model, kin, step.system.wrench) + step.system.joint;
  // The residual of a solve is rounding of its terms.
  EXPECT_LT(relative_error(dense(s.model, kin, step.system.op) * step.qdot, g), 1e-10);
  EXPECT_EQ(s.solver.warm.size(), 0U);
}

TEST(Step, IsBilateralWhereOnlyTheHeadIsClamped) {
  Stage s;
  s.state = bent_state(s.model, 0.02, 0.05);
  s.control.tip.value << 1, 1, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::kkt);
  ASSERT_EQ(step.rows.size(), 6U);
  EXPECT_EQ(step.prescribed, 6);
  EXPECT_EQ(step.iterations, 0);
  EXPECT_EQ(step.qp_time, 0);
  expect_optimal(s, step);
  // The paper's Eq. 3, dense: condition of H times rounding.
  const Observation now = observe(s.model, s.state, s.scene);
  const State paper = paper_step(s.input(now), step.rows, nullptr);
  EXPECT_LT(relative_error(step.qdot, paper.qdot), 1e-8);
}

TEST(Step, TakesActiveTorquesImplicitly) {
  for (const unsigned seed : {95U, 96U}) {
    Stage s = knotted(seed, 1);
    Random random(seed);
    ActiveTorque& active = s.control.active;
    active.value = random_entries(random, s.model.nv(), 1e5);
    active.rate = random_entries(random, s.model.nv(), 1e3).cwiseAbs();
    active.value.head<root_dofs>().setZero();
    active.rate.head<root_dofs>().setZero();
    const StepSolution step = s.solve();
    expect_optimal(s, step);
    // The paper's step, dense, with the torques in f and their rates in D.
    EXPECT_LT(relative_error(step.qdot, paper_velocity(s)), 1e-6);
    const Eigen::VectorXd applied = active.value - active.rate.cwiseProduct(step.qdot);
    EXPECT_EQ(step.active_torque, applied);
    EXPECT_TRUE(step.active_torque.head<root_dofs>().isZero(0));
    // What is left of the motion's force without it is the rows'.
    EXPECT_LT(relative_error(step.net_force - applied, step.force.total()), 1e-8);
    const Kinematics kin = kinematics(s.model, s.state);
    const Eigen::MatrixXd h = dense(s.model, kin, step.system.op);
    EXPECT_EQ(h, h.transpose());
    // Torques asked for besides are the same, and join them.
    Stage twice = s;
    twice.control.torque = active;
    active.value *= 2;
    active.rate *= 2;
    const StepSolution both = twice.solve();
    const StepSolution doubled = s.solve();
    EXPECT_LT(relative_error(both.qdot, doubled.qdot), 1e-12);
    EXPECT_LT(relative_error(both.active_torque, doubled.active_torque), 1e-12);
    EXPECT_LT(relative_error(twice.solve().qdot, paper_velocity(twice)), 1e-6);
  }
}

TEST(Step, IsOptimalAtEveryStepSize) {
  for (const double h : {5e-4, 2e-3, 1e-2, 5e-2}) {
    for (const unsigned seed : {92U, 93U, 94U}) {
      Stage s = knotted(seed, 1);
      s.scene.time.step = h;
      SCOPED_TRACE("h = " + std::to_string(h) + ", seed " + std::to_string(seed));
      expect_optimal(s, s.solve());
    }
  }
}

TEST(Step, IsOptimalWithThePositionScriptsSpring) {
  Stage s = knotted(95, 1);
  s.control.tip.rate = 26;
  const StepSolution step = s.solve();
  expect_optimal(s, step);
  const Kinematics kin = kinematics(s.model, s.state);
  const Eigen::Vector3d velocity = centre_jacobian(s.model, kin, 99) * step.qdot;
  EXPECT_LT(relative_error(step.tip, s.control.tip.value - 26 * velocity), 1e-12);
}

TEST(Step, IsOptimalAgainstTheHeadPlate) {
  Stage s;
  s.state.q[0] = -3;  // all bodies behind the neck start in the plate or near it
  s.control.clamp_head = false;
  s.control.tip.value << -500, 20, 0;
  const StepSolution step = s.solve();
  EXPECT_EQ(step.kind, SolveKind::qp);
  EXPECT_GT(step.force[RowKind::obstacle].lpNorm<Eigen::Infinity>(), 0);
  expect_optimal(s, step);
}

TEST(Step, ForcesByKindAddUpToTheRows) {
  Stage s = knotted(96, 1);
  const StepSolution step = s.solve();
  const Kinematics kin = kinematics(s.model, s.state);
  const double h = s.scene.time.step;
  for (const RowKind kind : row_kinds) {
    const Eigen::VectorXd& force = step.force[kind];
    Eigen::VectorXd lambda = step.lambda / h;  // Eq. 8
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      if (step.rows[i].kind != kind) lambda[static_cast<Eigen::Index>(i)] = 0;
    }
    const Eigen::VectorXd expected = dense_rows(s.model, kin, step.rows).transpose() * lambda;
    // Terms of opposite strands cancel: rounding of the largest term, not of the sum.
    const double scale = step.force.total().lpNorm<Eigen::Infinity>();
    EXPECT_LT((force - expected).lpNorm<Eigen::Infinity>() / scale, 1e-12);
  }
}

TEST(Step, StationarityStaysSmallWhereTheClampHardlyPulls) {
  // Across a straight body a pull at the tail hardly reaches the head: its force is 1e-40 dyn, and
  // what rounding leaves of H q̇ is larger.
  Stage s;
  s.control.tip.value << 0, 1, 0;
  EXPECT_LE(s.solve().stationarity, 1e-9);
}

}  // namespace hagfish::step_test
