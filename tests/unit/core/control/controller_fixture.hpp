// The controller on made-up observations: it sees contacts and centres, and neither needs to come
// from a simulation.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/control/controller.hpp"
#include "core/step/outcome.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish {

/// Between the bodies at these arcs, cm.
inline Contact contact(double arc_a, double arc_b, double gap = 0) {
  Contact c;
  c.arc_a = arc_a;
  c.arc_b = arc_b;
  c.segment_a = static_cast<int>(arc_a / 0.424);
  c.segment_b = static_cast<int>(arc_b / 0.424);
  c.gap = gap;
  c.normal = Eigen::Vector3d::UnitX();
  c.tangent_a = Eigen::Vector3d::UnitY();
  c.tangent_b = Eigen::Vector3d::UnitZ();
  return c;
}

/// A controller of the Table 1 animal that sees made-up contacts and centres.
class ControllerTest : public testing::Test {
 protected:
  Scene scene = table1_scene();
  Model model = table1_hagfish();
  ControllerState state;
  NamedLaw named;
  ObservedState seen;
  Observation& observation = seen.observation;
  double now = 0;

  ControllerTest() {
    scene.expect.knot = "3_1";
    scene.script.kind = ScriptSettings::Kind::force;
    scene.script.waypoints = {{0, {10, 20, 30}}, {5, {50, 60, 70}}};
    scene.controller.contact_gap = 0.05;
    scene.controller.tail_through = 8;
    scene.controller.tight_span = 20.352;
    scene.controller.tight_hold = 0.1;
    scene.controller.tighten_time = 2;
    scene.controller.release_at = 1.908;
    scene.knot.interval = 0.01;
    scene.time.step = 0.002;
    seen.state = rest_state(model);
    observation.kin = kinematics(model, seen.state);
    observation.segments = spline(model, observation.kin.centre);
  }

  /// Centres on an open overhand knot or on a line.
  void tie(bool knotted) {
    for (int b = 0; b < model.body_count(); ++b) {
      const double t = (b + 0.5) / model.body_count();
      observation.kin.centre.col(b) =
          knotted ? trefoil_point(t, 2.45) : Eigen::Vector3d(42.4 * t, 0, 0);
    }
  }

  Control step(std::vector<Contact> contacts) {
    observation.contact.contacts = std::move(contacts);
    observation.ends = {};
    for (const Contact& c : observation.contact.contacts) {
      if (c.gap > scene.controller.contact_gap) continue;
      std::optional<Contact>&first = observation.ends.first, &last = observation.ends.last;
      if (!first || c.arc_a < first->arc_a) first = c;
      if (!last || c.arc_b > last->arc_b) last = c;
      observation.ends.head_end = first->arc_a;
      observation.ends.tail_end = last->arc_b;
    }
    Control control;
    const Status status = decide(model, scene, seen, now, named, state, control);
    if (!status.ok()) throw StepError(status);
    now += scene.time.step;
    return control;
  }

  /// In `phase` with a knot that spans 5 to 30 cm.
  void start_in(Phase phase) {
    tie(true);
    state.phase = phase;
    state.phase_start = now;
    state.loose = now;
    state.knot = knot_type(observation.kin.centre, scene.knot);
    state.knot_seen = now;
  }

  /// What the controller complains of at a step.
  std::string complaint(std::vector<Contact> contacts) {
    try {
      step(std::move(contacts));
    } catch (const StepError& error) {
      return error.what();
    }
    return "none";
  }
};

}  // namespace hagfish
