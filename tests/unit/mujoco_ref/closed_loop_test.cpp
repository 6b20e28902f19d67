// Runs in MuJoCo: its steps are the core's where nothing touches, and what it lacks is refused.
#include "mujoco_ref/closed_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/errors.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::closed_loop_test {

/// A bent animal that copies itself by the reflex, in water, touching nothing.
Scene bent_scene() {
  Scene scene = table1_scene();
  scene.wall.present = false;
  scene.model.bending_stiffness = scene.model.twist_stiffness = 2e5;
  scene.model.bending_damping = scene.model.twist_damping = 3e3;
  scene.active = {5e5, 0.01, 1, 1e9};
  scene.start.bend = {{0, 0, 0.02, 0.01}, {1, 0.001, 0.1, -0.05}};
  scene.start.bend_rate = {{0, 0, 0.03, 0}, {1, 0, 0.01, 0.02}};
  scene.start.phase = Phase::slide;
  scene.controller.law = "reflex";
  scene.controller.reflex.shift = 0.02;
  scene.guard.action = GuardAction::warn;  // there is no knot to be lost
  return scene;
}

/// Where the bodies are after `time` (s) with steps of `h` (s), in MuJoCo or here, cm.
Eigen::Matrix3Xd moved(Scene scene, bool in_mujoco, double h, double time,
                       MujocoIntegrator integrator = MujocoIntegrator::euler) {
  scene.time.step = h;
  SceneRun run(table1_specimen(), scene);
  MujocoLoop mujoco(run.model, run.scene, {.integrator = integrator});
  while (run.time() < time - 0.5 * h) {
    if (in_mujoco) {
      mujoco.take_step(run.sim, run.record);
    } else {
      run.step();
    }
  }
  return run.sim.now.observation.kin.centre;
}

// Drag is explicit in MuJoCo and implicit here: apart in the first order in h.
TEST(ClosedLoop, MovesAsHereAsStepsShrink) {
  for (const bool clamped : {true, false}) {
    Scene scene = bent_scene();
    scene.clamp_head = clamped;
    const auto apart = [&](double h) {
      return (moved(scene, true, h, 0.2) - moved(scene, false, h, 0.2)).colwise().norm().maxCoeff();
    };
    const double way = (moved(scene, false, 0.001, 0.2) - moved(scene, false, 0.001, 0.001))
                           .colwise()
                           .norm()
                           .maxCoeff();
    EXPECT_GT(way, 0.5);
    EXPECT_LT(apart(0.001), 0.02 * way);
    EXPECT_LT(apart(0.0005), 0.6 * apart(0.001));
  }
}

// RK4 takes damping explicitly and needs far shorter steps; what both lead to is one motion.
TEST(ClosedLoop, MovesAlikeByEachIntegrator) {
  Scene scene = bent_scene();
  scene.model.bodies = 20;
  const double h = 2e-5, time = 0.02;
  const Eigen::Matrix3Xd usual = moved(scene, true, h, time);
  const double way = (usual - moved(scene, true, h, h)).colwise().norm().maxCoeff();
  for (const MujocoIntegrator integrator : {MujocoIntegrator::implicit, MujocoIntegrator::rk4}) {
    const Eigen::Matrix3Xd other = moved(scene, true, h, time, integrator);
    EXPECT_LT((other - usual).colwise().norm().maxCoeff(), 0.02 * way);
    EXPECT_GT((other - usual).colwise().norm().maxCoeff(), 0);  // it was another one
  }
}

TEST(ClosedLoop, SaysWhatTheStepDid) {
  SceneRun run(table1_specimen(), bent_scene());
  const StepRecord& record = run.record;
  MujocoLoop mujoco(run.model, run.scene);
  const State before = run.sim.now.state;
  mujoco.take_step(run.sim, run.record);
  EXPECT_EQ(record.after.state.q, before.q);
  EXPECT_EQ(record.solution.next, run.sim.now.state.qdot);
  EXPECT_EQ(run.sim.step, 1);
  const ActiveTorque& asked = record.control.active;
  const Eigen::VectorXd torque = asked.value - asked.rate.cwiseProduct(record.solution.next);
  EXPECT_LE((record.solution.active_torque - torque).norm(), 1e-12 * torque.norm());
  EXPECT_TRUE(std::isnan(record.solution.worst_residual()));
  EXPECT_TRUE(record.solution.force[RowKind::contact].isZero(0));
}

TEST(ClosedLoop, RefusesWhatMujocoHasNot) {
  const auto complaint = [](const auto& change) {
    Scene scene = bent_scene();
    change(scene);
    const Model model = make_hagfish(table1_specimen(), scene);
    return error_of([&] { MujocoLoop(model, scene); });
  };
  EXPECT_EQ(complaint([](Scene&) {}), "no error");
  EXPECT_NE(complaint([](Scene& s) { s.wall.present = true; }).find("wall.present"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.script.kind = ScriptSettings::Kind::force; }).find("script"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.time.rule = TimeRule::midpoint; }).find("time.rule"),
            std::string::npos);
}

}  // namespace hagfish::closed_loop_test
