// What take_step promises: a step that cannot be taken leaves the simulation as it was.
#include "core/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>
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

void PrintTo(const Hindrance& hindrance, std::ostream* out) { *out << hindrance.name; }

bool same(const std::optional<Contact>& a, const std::optional<Contact>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->arc_a == b->arc_a && a->arc_b == b->arc_b && a->gap == b->gap));
}

/// EXPECTs that all is the same which the future of a run depends on.
void expect_same(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.now.state.q, b.now.state.q);
  EXPECT_EQ(a.now.state.qdot, b.now.state.qdot);
  EXPECT_EQ(a.now.observation.kin.centre, b.now.observation.kin.centre);
  EXPECT_EQ(a.now.observation.kin.twist, b.now.observation.kin.twist);
  EXPECT_EQ(a.now.observation.contact.contacts.size(), b.now.observation.contact.contacts.size());
  EXPECT_EQ(a.now.observation.penetration, b.now.observation.penetration);

  const ControllerState &c = a.controller, &d = b.controller;
  EXPECT_EQ(c.phase, d.phase);
  EXPECT_EQ(c.phase_start, d.phase_start);
  EXPECT_EQ(c.loose, d.loose);
  EXPECT_EQ(c.knot.type, d.knot.type);
  EXPECT_EQ(c.knot_seen, d.knot_seen);
  EXPECT_EQ(c.knot_from, d.knot_from);
  EXPECT_EQ(c.lost, d.lost);
  EXPECT_EQ(c.memory, d.memory);
  EXPECT_EQ(c.rest_shape, d.rest_shape);
  EXPECT_TRUE(same(c.ends.first, d.ends.first) && same(c.ends.last, d.ends.last));

  EXPECT_EQ(std::memcmp(&a.ledger, &b.ledger, sizeof(EnergyLedger)), 0);
  EXPECT_EQ(a.watch.warned, b.watch.warned);
  EXPECT_TRUE(std::ranges::equal(
      a.watch.capped, b.watch.capped,
      [](const CapWatch& s, const CapWatch& t) { return s.id == t.id && s.since == t.since; }));
  EXPECT_EQ(a.solver.warm.size(), b.solver.warm.size());

  const Candidates& e = a.search.candidates;
  const Candidates& f = b.search.candidates;
  EXPECT_EQ(e.displacement, f.displacement);
  EXPECT_EQ(e.clear_until, f.clear_until);
  EXPECT_EQ(e.first, f.first);
  EXPECT_EQ(e.ends.point, f.ends.point);
  EXPECT_EQ(e.ends.third, f.ends.third);
  EXPECT_TRUE(std::ranges::equal(e.pairs, f.pairs, [](const SegmentPair& s, const SegmentPair& t) {
    return s.a == t.a && s.b == t.b;
  }));
  using Closest = std::optional<ClosestPoints>;
  EXPECT_TRUE(std::ranges::equal(e.closest, f.closest, [](const Closest& s, const Closest& t) {
    return s.has_value() == t.has_value() && (!s || (s->t_a == t->t_a && s->t_b == t->t_b));
  }));
}

class StoppedStep : public testing::TestWithParam<Hindrance> {};

TEST_P(StoppedStep, LeavesTheSimulationAsItWas) {
  const Hindrance& hindrance = GetParam();
  const Scene scene = stored_scene().scene;
  const Model model = make_hagfish(stored_scene().specimen, scene);
  const std::vector<StoredState> states = stored_states();
  const auto found = std::ranges::find(states, hindrance.from, &StoredState::name);
  ASSERT_NE(found, states.end());
  Simulation sim = resume(model, scene, *found);
  StepRecord record;
  for (int k = 0; k < 5; ++k) {
    take_step(model, scene, sim, record);
  }
  Simulation twin = sim;
  Scene harder = scene;
  Model other = model;
  hindrance.set(harder, other);
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      take_step(other, harder, sim, record);
      FAIL() << "the step was taken";
    } catch (const StepError& error) {
      EXPECT_EQ(error.outcome(), hindrance.cause) << error.what();
    }
    EXPECT_EQ(record.controller.phase, twin.controller.phase);
    expect_same(sim, twin);
  }
  StepRecord record_of_twin;
  for (int k = 0; k < 20; ++k) {
    take_step(model, scene, sim, record);
    take_step(model, scene, twin, record_of_twin);
    ASSERT_EQ(record.solution.lambda, record_of_twin.solution.lambda) << k;
    expect_same(sim, twin);
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
