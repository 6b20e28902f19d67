// How a run starts, goes on from the state of another, and ends.
#include <gtest/gtest.h>

#include <cmath>

#include "core/chain/start.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::simulation_start_test {

/// Ten bodies in open water, pulled at the tail.
struct Pulled : SceneRun {
  Pulled() : SceneRun(table1_specimen(), table1_scene(10)) {
    scene.script.kind = ScriptSettings::Kind::force;
    scene.script.waypoints = {{0, {100, 200, 0}}, {1, {100, -200, 50}}};
    begin();
  }
  void begin() { sim = start(model, scene, "active-set"); }
};

TEST(SimulationStart, IsTheScenesStateAtTimeZero) {
  Pulled p;
  p.scene.start.phase = Phase::slide;
  p.scene.start.bend = {{0, 0, 0.05, 0.02}, {1, 0, 0.05, 0.02}};
  p.scene.clamp_head = false;
  p.scene.start.spin = {1, 2, 3};
  p.begin();
  const Simulation& sim = p.sim;
  EXPECT_EQ(sim.step, 0);
  EXPECT_EQ(p.time(), 0);
  EXPECT_EQ(p.phase(), Phase::slide);
  EXPECT_EQ(sim.controller.phase_start, 0);
  const State state = start_state(p.model, p.scene.start);
  EXPECT_EQ(sim.now.state.q, state.q);
  EXPECT_EQ(sim.now.state.qdot, state.qdot);
  EXPECT_EQ(sim.now.state.qdot.segment<3>(3), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sim.now.observation.kin.centre, kinematics(p.model, state).centre);
  EXPECT_FALSE(p.over());
}

TEST(SimulationStart, AnotherSceneHasNoMemoryOrRestShapeOfAnotherLaw) {
  Pulled p;
  Simulation& sim = p.sim;
  sim.controller.memory = Eigen::Vector2d(30, 1);
  sim.controller.rest_shape = Eigen::VectorXd::Constant(p.model.nv(), 0.1);
  Scene programmed = p.scene;
  programmed.script.kind = ScriptSettings::Kind::curvature;
  change_scene(p.model, programmed, programmed, sim);
  EXPECT_EQ(sim.controller.memory.size(), 2);
  EXPECT_EQ(sim.controller.rest_shape.size(), p.model.nv());
  Scene other = p.scene;
  other.controller.law = "knot_speed";
  change_scene(p.model, programmed, other, sim);
  EXPECT_EQ(sim.controller.memory.size(), 0);
  EXPECT_EQ(sim.controller.rest_shape.size(), 0);
}

/// Takes `count` steps of `sim`, each also asked to stop at one call of its back end after the
/// other: then it must not be taken, or end as without that. How many were not; `corrected` are
/// those whose path asked for rows.
int stops_at_every_call(SceneRun run, int count, int& corrected) {
  int stopped = 0;
  const State& now = run.sim.now.state;
  for (int step = 0; step < count; ++step) {
    const Simulation before = run.sim;
    corrected += run.step().solution.path_rows.empty() ? 0 : 1;
    for (int k = 1, calls = k; calls >= k; ++k) {
      Simulation asked = before;
      calls = 0;
      asked.solver.stop_when([&] { return ++calls >= k; });
      try {
        take_step(run.model, run.scene, asked);
        EXPECT_EQ(asked.now.state.q, now.q) << "step " << step << ", call " << k;
        EXPECT_EQ(asked.now.state.qdot, now.qdot) << "step " << step << ", call " << k;
      } catch (const StepError& error) {
        EXPECT_EQ(error.outcome(), Outcome::stopped);
        ++stopped;
      }
    }
  }
  return stopped;
}

TEST(SimulationStart, AStepThatIsAskedToStopIsTheSameOrNotTaken) {
  int corrected = 0;
  for (const char* state : {"slide", "slide late"}) {
    const SceneRun run = resumed(stored_state(state), {"time.step=0.01"});
    EXPECT_GT(stops_at_every_call(run, 150, corrected), 300);
  }
  // Strands that meet in open water: only the path asks for a row.
  corrected = 0;
  const SceneRun closing(HAGFISH_STRESS_DIR "/closing.toml", {"time.step=0.002"});
  EXPECT_GT(stops_at_every_call(closing, 30, corrected), 0);
  EXPECT_GT(corrected, 0);
}

TEST(SimulationStart, GoesOnFromTheStateOfAnotherRun) {
  Pulled p;
  for (int k = 0; k < 20; ++k) p.step();
  Pulled other;
  other.sim =
      start_from(p.model, p.scene, "active-set", p.sim.now.state, p.sim.controller, p.sim.step);
  for (int k = 0; k < 20; ++k) {
    p.step();
    EXPECT_EQ(other.step().time, (20 + k) * p.scene.time.step);
  }
  EXPECT_EQ(other.sim.step, 40);
  // It has no multipliers to start from: rounding of the solver, some 1e-13, over twenty steps.
  EXPECT_LE(relative_error(other.sim.now.state.q, p.sim.now.state.q), 1e-10);
  EXPECT_LE(relative_error(other.sim.now.state.qdot, p.sim.now.state.qdot), 1e-10);
}

TEST(SimulationStart, GoesOnInThePhaseThatItIsGiven) {
  for (const StoredState& stored : stored_states()) {
    EXPECT_EQ(resumed(stored).step().controller.phase, stored.phase);
  }
}

TEST(SimulationEnd, IsAtTheStepNearestTheDuration) {
  Pulled p;
  for (const double step : {0.1, 0.03, 0.007, 0.002}) {
    for (const int count : {1, 3, 8, 11}) {
      for (const double off : {-0.4, 0.0, 0.4}) {
        p.scene.time.step = step;
        p.scene.time.duration = (count + off) * step;
        p.begin();
        while (!p.over()) p.step();
        EXPECT_EQ(p.sim.step, count) << step << " " << off;
      }
    }
  }
}

TEST(SimulationEnd, ComesWithThePhaseAfterTheLastOne) {
  Pulled p;
  const std::vector<Phase> order = {Phase::form,    Phase::tighten, Phase::slide,
                                    Phase::reverse, Phase::release, Phase::free};
  for (std::size_t until = 0; until < order.size(); ++until) {
    p.scene.time.until = order[until];
    for (std::size_t now = 0; now < order.size(); ++now) {
      p.sim.controller.phase = order[now];
      EXPECT_EQ(p.over(), now > until) << until << " " << now;
    }
  }
}

TEST(SimulationEnd, ComesATimeAfterTheKnotIsGone) {
  Pulled p;
  p.scene.time.step = 0.01;
  p.scene.controller.free_time = 0.5;
  ControllerState controller;
  controller.phase_start = 2;
  const auto over = [&](Phase phase, std::int64_t step) {
    controller.phase = phase;
    return finished(
        start_from(p.model, p.scene, "active-set", rest_state(p.model), controller, step), p.scene);
  };
  EXPECT_FALSE(over(Phase::free, 249));
  EXPECT_TRUE(over(Phase::free, 250));
  EXPECT_FALSE(over(Phase::release, 250));
}

TEST(SimulationMisuse, ALawTakesNoStepOfItsOwnSimulation) {
  Pulled p;
  p.scene.controller.law = own_law;
  int refused = 0;
  p.sim.law = [&](const Situation&, Eigen::VectorXd&, Control&) {
    EXPECT_THROW(take_step(p.model, p.scene, p.sim), std::logic_error);
    ++refused;
  };
  for (int k = 0; k < 10; ++k) p.step();
  EXPECT_EQ(p.sim.step, 10);
  EXPECT_EQ(refused, 10);
}

TEST(SimulationMisuse, NoBodiesOrAStateOfAnotherLengthIsNoStart) {
  const Pulled p;
  EXPECT_THROW(start(Model{}, p.scene, "active-set"), std::invalid_argument);
  const State good = start_state(p.model, p.scene.start);
  for (const State& state : {State{good.q.head(12), good.qdot}, {good.q, good.qdot.head(3)}}) {
    EXPECT_THROW(start_from(p.model, p.scene, "active-set", state, {}, 0), std::invalid_argument);
  }
}

TEST(SimulationMisuse, ASimulationOfAnotherAnimalOrMovedFromTakesNoStep) {
  Pulled p;
  for (const int bodies : {4, 40}) {
    EXPECT_THROW(take_step(table1_hagfish(bodies), p.scene, p.sim), std::invalid_argument);
  }
  Simulation taken = std::move(p.sim);
  EXPECT_THROW(p.step(), std::invalid_argument);
  take_step(p.model, p.scene, taken);
  EXPECT_EQ(taken.step, 1);
}

}  // namespace hagfish::simulation_start_test
