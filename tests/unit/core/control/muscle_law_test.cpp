// The law that moves the animal by activations: what it leaves of the paper's control, and the lag
// of its muscles.
#include "core/control/muscle_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/muscle/activation.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::muscle_law_test {

Eigen::VectorXd activations_in(const Model& model, const Eigen::VectorXd& memory) {
  return memory.tail(static_cast<Eigen::Index>(model.muscles.size()));
}

class MuscleLaw : public testing::Test, protected SceneRun {
 protected:
  MuscleLaw()
      : SceneRun(resumed(
            stored_state("slide"),
            {"muscle.present=true", "muscle.activation_time=0.1", "controller.law=muscles"})) {
    // Contacts are followed, and the paper's control of the same step known.
    Scene paper = scene;
    paper.controller.law = "paper";
    Simulation other = sim;
    reference = take_step(model, paper, other);
  }

  StepRecord reference;
};

TEST_F(MuscleLaw, FollowsWhatThePaperAsksForByItsDynamicsAlone) {
  ASSERT_EQ(reference.control.thigmotaxis.size(), 2u);
  MuscleEffort wanted;
  ActivationSolver().solve(
      model, sim.now.observation.kin,
      reference.solution.active_torque + reference.solution.force[RowKind::thigmotaxis], wanted);
  ASSERT_GT(wanted.activation.maxCoeff(), 1e-4);
  step();
  EXPECT_TRUE(record.control.thigmotaxis.empty());
  EXPECT_EQ(record.control.rest_shape.size(), 0);
  EXPECT_TRUE(record.solution.force[RowKind::thigmotaxis].isZero(0));
  const Eigen::VectorXd first = activations_in(model, record.controller.memory);
  const double gone = 1 - std::exp(-scene.time.step / 0.1);
  // The paper's step was solved from another warm start.
  EXPECT_NEAR((first - gone * wanted.activation).lpNorm<Eigen::Infinity>(), 0,
              1e-7 * wanted.activation.maxCoeff());
  Eigen::VectorXd torque;
  muscle_torque(model, record.after.observation.kin, first, torque);
  EXPECT_EQ(record.solution.active_torque, torque);
  // Later they stay between 0 and 1, and what they do follows from state and memory.
  for (int k = 0; k < 20; ++k) step();
  Simulation copy = sim;
  copy.solver.warm = {};
  EXPECT_EQ(step().control.torque.value, take_step(model, scene, copy).control.torque.value);
  const Eigen::VectorXd later = activations_in(model, sim.controller.memory);
  EXPECT_GE(later.minCoeff(), 0);
  EXPECT_LE(later.maxCoeff(), 1);
}

/// While the knot forms: what the spring towards the program will be when the muscles answer.
TEST_F(MuscleLaw, AsksAheadOfItsLagWhileTheKnotForms) {
  constexpr double lag = 0.1, turn = 3;  // s; of the whole body at 1 s, rad
  scene.script.kind = ScriptSettings::Kind::curvature;
  scene.script.curvature = {
      {0, 1}, {0, 1}, {Eigen::Matrix3Xd::Zero(3, 2), Eigen::Matrix3Xd::Constant(3, 2, turn)}, {}};
  scene.active = {500, 0.01, 1, 1e9};
  scene.start.phase = Phase::form;
  State state = sim.now.state;  // bent, and moving
  sim = start_from(model, scene, "active-set", state, {}, 100);
  Scene own = scene;
  own.controller.law = own_law;
  Simulation other = sim;
  other.law = [&](const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
    control.torque.value.setZero(model.nv());
    control.torque.rate.setZero(model.nv());
    const double ahead = scene.time.step + lag;
    for (int k = root_dofs; k < model.nv(); ++k) {
      const Hinge& hinge = model.hinges[k - root_dofs];
      const double span = hinge_span(model, hinge.body);
      const double shape = (at.time + ahead) * turn * span / model.length();
      const double stiffness = scene.active.stiffness / span;
      control.torque.value[k] = stiffness * (shape - state.q[k + 1]) + hinge.stiffness * shape;
      control.torque.rate[k] = stiffness * ahead;
    }
  };
  const StepRecord asked = take_step(model, own, other);
  MuscleEffort wanted;
  ActivationSolver().solve(model, sim.now.observation.kin, asked.solution.active_torque, wanted);
  step();
  const double gone = 1 - std::exp(-scene.time.step / lag);
  EXPECT_NEAR((activations_in(model, record.controller.memory) - gone * wanted.activation)
                  .lpNorm<Eigen::Infinity>(),
              0, 1e-7 * gone * wanted.activation.maxCoeff());
}

TEST_F(MuscleLaw, HasNoShapeToFollowWhereAForceScriptTiesTheKnot) {
  ASSERT_EQ(scene.script.kind, ScriptSettings::Kind::force);
  sim = start(model, scene, "active-set");
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(step().controller.phase, Phase::form);
    EXPECT_TRUE(activations_in(model, record.controller.memory).isZero(0));
  }
}

TEST_F(MuscleLaw, ExcitesNothingFromReleaseOn) {
  for (int k = 0; k < 20; ++k) step();
  const Eigen::VectorXd before = activations_in(model, sim.controller.memory);
  ASSERT_GT(before.maxCoeff(), 1e-4);
  sim.controller.phase = Phase::release;
  step();
  const Eigen::VectorXd after = std::exp(-scene.time.step / 0.1) * before;
  EXPECT_LE((activations_in(model, sim.controller.memory) - after).lpNorm<Eigen::Infinity>(),
            1e-15);
}

}  // namespace hagfish::muscle_law_test
