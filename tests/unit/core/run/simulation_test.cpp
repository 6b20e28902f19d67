// What take_step promises: a step that cannot be taken leaves the simulation as it was.
#include "core/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>

#include "tests/support/stored_states.hpp"

namespace hagfish::simulation_test {

/// A cause that stops a step, and what brings it about.
struct Hindrance {
  std::string name;
  Outcome cause;
  std::string from;  ///< stored state
  std::function<void(Scene&, Model&)> set;
};

/// EXPECTs the same motion, controller, ledger and watch. That nothing else differs which the
/// future of a run depends on, the steps to come show.
void expect_same(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.now.state.q, b.now.state.q);
  EXPECT_EQ(a.now.state.qdot, b.now.state.qdot);
  EXPECT_EQ(a.now.observation.penetration, b.now.observation.penetration);
  const ControllerState &c = a.controller, &d = b.controller;
  EXPECT_EQ(c.phase, d.phase);
  EXPECT_EQ(c.phase_start, d.phase_start);
  EXPECT_EQ(c.knot.type, d.knot.type);
  EXPECT_EQ(c.knot_seen, d.knot_seen);
  EXPECT_EQ(c.lost, d.lost);
  EXPECT_EQ(c.memory, d.memory);
  EXPECT_EQ(c.rest_shape, d.rest_shape);
  EXPECT_EQ(std::memcmp(&a.ledger, &b.ledger, sizeof(EnergyLedger)), 0);
  EXPECT_EQ(a.watch.warned, b.watch.warned);
  EXPECT_EQ(a.watch.capped.size(), b.watch.capped.size());
  EXPECT_EQ(a.solver.warm.size(), b.solver.warm.size());
}

class StoppedStep : public testing::TestWithParam<Hindrance> {};

TEST_P(StoppedStep, LeavesTheSimulationAsItWas) {
  const Hindrance& hindrance = GetParam();
  SceneRun run = resumed(stored_state(hindrance.from));
  for (int k = 0; k < 5; ++k) run.step();
  SceneRun twin = run;
  hindrance.set(run.scene, run.model);
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      run.step();
      FAIL() << "the step was taken";
    } catch (const StepError& error) {
      EXPECT_EQ(error.outcome(), hindrance.cause) << error.what();
    }
    EXPECT_EQ(run.record.controller.phase, twin.phase());
    expect_same(run.sim, twin.sim);
  }
  run.scene = twin.scene;
  run.model = twin.model;
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(run.step().solution.lambda, twin.step().solution.lambda) << k;
    expect_same(run.sim, twin.sim);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Causes, StoppedStep,
    testing::Values(Hindrance{"penetration", Outcome::penetration, "slide",
                              [](Scene& scene, Model&) {
                                scene.guard.action = GuardAction::stop;
                                scene.guard.penetration = -1;
                              }},
                    Hindrance{"limits", Outcome::limits, "slide",
                              [](Scene& scene, Model&) {
                                scene.guard.action = GuardAction::stop;
                                scene.guard.limit_violation = -1;
                              }},
                    Hindrance{"speed", Outcome::speed, "slide",
                              [](Scene& scene, Model&) { scene.guard.speed = 0; }},
                    Hindrance{"energy", Outcome::energy_gain, "slide",
                              [](Scene& scene, Model&) {
                                scene.guard.energy_action = EnergyAction::stop;
                                scene.guard.energy_gain = -1;
                              }},
                    Hindrance{"knotLost", Outcome::knot_lost, "slide",
                              [](Scene& scene, Model&) {
                                scene.guard.action = GuardAction::stop;
                                scene.expect.knot = "4_1";
                                scene.knot.interval = 0;
                              }},
                    Hindrance{"neverTied", Outcome::never_tied, "form",
                              [](Scene& scene, Model&) {
                                scene.expect.knot = "4_1";
                                scene.script.waypoints.resize(2);
                                scene.knot.interval = 0;
                              }},
                    Hindrance{"infeasible", Outcome::infeasible, "slide",
                              [](Scene&, Model& model) {  // both limits of a hinge push
                                model.hinges[20].lower = 0.1;
                                model.hinges[20].upper = -0.1;
                              }}),
    [](const auto& hindrance) { return hindrance.param.name; });

}  // namespace hagfish::simulation_test
