// How a run starts, goes on from the state of another, and ends.
#include <gtest/gtest.h>

#include <cmath>

#include "core/chain/start.hpp"
#include "core/run/simulation.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::simulation_start_test {

/// Ten bodies in open water, pulled at the tail.
struct Pulled {
  Pulled() {
    scene.script.kind = ScriptSettings::Kind::force;
    scene.script.waypoints = {{0, {100, 200, 0}}, {1, {100, -200, 50}}};
  }
  Scene scene = table1_scene(10);
  Model model = table1_hagfish(10);
};

/// Steps that a run of `scene` takes before it is over.
std::int64_t steps_of(const Model& model, const Scene& scene) {
  Simulation sim = start(model, scene, "active-set");
  StepRecord record;
  while (!finished(sim, scene)) {
    take_step(model, scene, sim, record);
  }
  return sim.step;
}

TEST(SimulationStart, IsTheScenesStateAtTimeZero) {
  Pulled p;
  p.scene.start.phase = Phase::slide;
  p.scene.start.bend = {{0, 0, 0.05, 0.02}, {1, 0, 0.05, 0.02}};
  p.scene.clamp_head = false;
  p.scene.start.spin = {1, 2, 3};
  const Simulation sim = start(p.model, p.scene, "active-set");
  EXPECT_EQ(sim.step, 0);
  EXPECT_EQ(time_of(sim, p.scene), 0);
  EXPECT_EQ(sim.controller.phase, Phase::slide);
  EXPECT_EQ(sim.controller.phase_start, 0);
  const State state = start_state(p.model, p.scene.start);
  EXPECT_EQ(sim.now.state.q, state.q);
  EXPECT_EQ(sim.now.state.qdot, state.qdot);
  EXPECT_EQ(sim.now.state.qdot.segment<3>(3), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sim.now.observation.kin.centre, kinematics(p.model, state).centre);
  EXPECT_FALSE(finished(sim, p.scene));
}

TEST(SimulationStart, AnotherSceneHasNoMemoryOrRestShapeOfAnotherLaw) {
  const Pulled p;
  Simulation sim = start(p.model, p.scene, "active-set");
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
int stops_at_every_call(const Model& model, const Scene& scene, int count, Simulation sim,
                        int& corrected) {
  int stopped = 0;
  for (int step = 0; step < count; ++step) {
    const Simulation before = sim;
    corrected += take_step(model, scene, sim).solution.path_rows.empty() ? 0 : 1;
    for (int k = 1, calls = k; calls >= k; ++k) {
      Simulation asked = before;
      calls = 0;
      asked.solver.stop_when([&] { return ++calls >= k; });
      try {
        take_step(model, scene, asked);
        EXPECT_EQ(asked.now.state.q, sim.now.state.q) << "step " << step << ", call " << k;
        EXPECT_EQ(asked.now.state.qdot, sim.now.state.qdot) << "step " << step << ", call " << k;
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
  const ResolvedScene resolved = stored_scene({"time.step=0.01"});
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  for (const StoredState& stored : stored_states()) {
    if (stored.phase != Phase::slide) continue;
    const Simulation sim = resume(model, resolved.scene, stored);
    EXPECT_GT(stops_at_every_call(model, resolved.scene, 150, sim, corrected), 300);
  }
  // Strands that meet in open water: only the path asks for a row.
  corrected = 0;
  const ResolvedScene closing = read_scene(HAGFISH_STRESS_DIR "/closing.toml", {"time.step=0.002"});
  const Model strands = make_hagfish(closing.specimen, closing.scene);
  const Simulation sim = start(strands, closing.scene, "active-set");
  EXPECT_GT(stops_at_every_call(strands, closing.scene, 30, sim, corrected), 0);
  EXPECT_GT(corrected, 0);
}

TEST(SimulationStart, GoesOnFromTheStateOfAnotherRun) {
  const Pulled p;
  Simulation sim = start(p.model, p.scene, "active-set");
  for (int k = 0; k < 20; ++k) {
    take_step(p.model, p.scene, sim);
  }
  Simulation other =
      start_from(p.model, p.scene, "active-set", sim.now.state, sim.controller, sim.step);
  for (int k = 0; k < 20; ++k) {
    take_step(p.model, p.scene, sim);
    const StepRecord record = take_step(p.model, p.scene, other);
    EXPECT_EQ(record.time, (20 + k) * p.scene.time.step);
  }
  EXPECT_EQ(other.step, 40);
  // It has no multipliers to start from: rounding of the solver, some 1e-13, over twenty steps.
  EXPECT_LE(relative_error(other.now.state.q, sim.now.state.q), 1e-10);
  EXPECT_LE(relative_error(other.now.state.qdot, sim.now.state.qdot), 1e-10);
}

TEST(SimulationStart, GoesOnInThePhaseThatItIsGiven) {
  const ResolvedScene resolved = stored_scene();
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  for (const StoredState& stored : stored_states()) {
    Simulation sim = resume(model, resolved.scene, stored);
    EXPECT_EQ(take_step(model, resolved.scene, sim).controller.phase, stored.phase);
  }
}

TEST(SimulationEnd, IsAtTheStepNearestTheDuration) {
  Pulled p;
  for (const double step : {0.1, 0.03, 0.007, 0.002}) {
    for (const int count : {1, 3, 8, 11}) {
      for (const double off : {-0.4, 0.0, 0.4}) {
        p.scene.time.step = step;
        p.scene.time.duration = (count + off) * step;
        EXPECT_EQ(steps_of(p.model, p.scene), count) << step << " " << off;
      }
    }
  }
}

TEST(SimulationEnd, ComesWithThePhaseAfterTheLastOne) {
  Pulled p;
  Simulation sim = start(p.model, p.scene, "active-set");
  const std::vector<Phase> order = {Phase::form,    Phase::tighten, Phase::slide,
                                    Phase::reverse, Phase::release, Phase::free};
  for (std::size_t until = 0; until < order.size(); ++until) {
    p.scene.time.until = order[until];
    for (std::size_t now = 0; now < order.size(); ++now) {
      sim.controller.phase = order[now];
      EXPECT_EQ(finished(sim, p.scene), now > until) << until << " " << now;
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
  Simulation sim = start(p.model, p.scene, "active-set");
  int refused = 0;
  sim.law = [&](const Situation&, Eigen::VectorXd&, Control&) {
    EXPECT_THROW(take_step(p.model, p.scene, sim), std::logic_error);
    ++refused;
  };
  for (int k = 0; k < 10; ++k) take_step(p.model, p.scene, sim);
  EXPECT_EQ(sim.step, 10);
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
  const Pulled p;
  Simulation sim = start(p.model, p.scene, "active-set");
  for (const int bodies : {4, 40}) {
    EXPECT_THROW(take_step(table1_hagfish(bodies), p.scene, sim), std::invalid_argument);
  }
  Simulation taken = std::move(sim);
  EXPECT_THROW(take_step(p.model, p.scene, sim), std::invalid_argument);
  take_step(p.model, p.scene, taken);
  EXPECT_EQ(taken.step, 1);
}

}  // namespace hagfish::simulation_start_test
