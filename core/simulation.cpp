#include "core/simulation.hpp"

#include <algorithm>
#include <utility>

#include "core/guard.hpp"
#include "core/look_ahead.hpp"
#include "core/start.hpp"

namespace hagfish {
namespace {

/// Moves by the step's velocity into record.state and record.situation. Where the path overlaps and
/// `correct` is set, adds the rows that see it and returns true: the step is to be solved again.
bool meets_overlap(const Model& model, const Scene& scene, bool correct, Simulation& sim,
                   StepRecord& record) {
  const double h = scene.time.step;
  const ConstraintSettings& settings = scene.constraints;
  correct = correct && settings.activation == Activation::speculative;
  guard_speed(record.solution.centre_velocity, scene.guard);
  const int count = looks(record.solution.centre_velocity, h, settings.stride);
  record.state.qdot = record.solution.qdot;
  record.crossing = 0;
  for (int i = 1; i <= count; ++i) {
    const double t = i < count ? h * i / count : h;
    advance(sim.state.q, record.solution.qdot, t, record.state.q);
    observe(model, record.state, scene, sim.search, record.situation);
    if (i < count) {
      record.crossing = std::max(record.crossing, record.situation.penetration);
    }
    if (correct && add_missed_rows(model, sim.situation, record.situation, t, scene,
                                   record.solution, record.solution.rows, sim.scratch.waiting)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Simulation start(const Model& model, const Scene& scene) {
  ControllerState controller;
  controller.phase = scene.start.phase;
  return start_from(model, scene, start_state(model, scene.start), controller, 0);
}

Simulation start_from(const Model& model, const Scene& scene, State state,
                      ControllerState controller, std::int64_t step) {
  Simulation sim;
  sim.step = step;
  sim.state = std::move(state);
  sim.controller = std::move(controller);
  observe(model, sim.state, scene, sim.search, sim.situation);
  sim.ledger = open_ledger(model, sim.state, sim.situation.kin);
  return sim;
}

bool finished(const Simulation& sim, const Scene& scene) {
  // Half a step of slack: the time of a step is a product and may fall short by rounding.
  const double time = time_of(sim, scene) + 0.5 * scene.time.step;
  return time >= scene.time.duration ||
         phase_order(sim.controller.phase) > phase_order(scene.time.until) ||
         (sim.controller.phase == Phase::free &&
          time >= sim.controller.phase_start + scene.controller.free_time);
}

void take_step(const Model& model, const Scene& scene, BoxQpSolver& solver, Simulation& sim,
               StepRecord& record) {
  const double h = scene.time.step;
  record.step = sim.step;
  record.time = time_of(sim, scene);
  record.warnings.clear();
  decide(model, scene, sim.situation, record.time, sim.controller, record.control);
  if (!sim.controller.lost.empty()) {
    report(StopCause::knot_lost, sim.controller.lost, GuardAction::warn, sim.watch,
           record.warnings);
  }
  begin_step(model, sim.state, sim.situation, record.control, scene, solver, sim.warm, sim.scratch,
             record.solution);
  // The record's old state and situation are storage for the next ones; then they change places.
  for (int k = 0; meets_overlap(model, scene, k < scene.constraints.corrections, sim, record);
       ++k) {
    resume_step(model, sim.situation, solver, sim.warm, sim.scratch, record.solution);
  }
  finish_step(model, sim.situation, record.control, scene, sim.warm, sim.scratch, record.solution);
  guard_cap(model, scene, record.solution, sim.scratch.qp.A, record.time, sim.watch,
            record.warnings);
  guard_state(model, record.state, record.situation, record.crossing, scene, sim.watch,
              record.warnings);

  record.ledger = sim.ledger;
  book_step(model, sim.situation.kin, record.solution, record.state, record.situation.kin, h,
            sim.ledger);
  guard_energy(model, scene, record.state, record.situation.kin, sim.ledger, sim.watch,
               record.warnings);
  record.head_drift = record.control.clamp_head ? head_drift(model, sim.situation.kin) : 0;
  record.controller = sim.controller;
  std::swap(record.state, sim.state);
  std::swap(record.situation, sim.situation);
  ++sim.step;
}

StepRecord take_step(const Model& model, const Scene& scene, BoxQpSolver& solver, Simulation& sim) {
  StepRecord record;
  take_step(model, scene, solver, sim, record);
  return record;
}

}  // namespace hagfish
