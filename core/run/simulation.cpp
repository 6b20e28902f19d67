#include "core/run/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/chain/start.hpp"
#include "core/run/guard.hpp"
#include "core/step/look_ahead.hpp"

namespace hagfish {
namespace {

/// Follows the step's velocity for time `t` (s) into record.state and record.observation.
void follow_path(const Model& model, const Scene& scene, double t, Simulation& sim,
                 StepRecord& record) {
  advance(sim.state.q, record.solution.qdot, t, record.state.q);
  observe(model, record.state, scene, sim.search, record.observation);
}

/// Moves by the step's velocity into record.state and record.observation. Where the path overlaps
/// or leaves a cone and `correct` is set, adds the rows that see it and returns true: the step is
/// to be solved again.
bool misses_rows(const Model& model, const Scene& scene, bool correct, Simulation& sim,
                 StepRecord& record) {
  const double h = scene.time.step;
  guard_speed(record.solution.centre_velocity, scene.guard);
  const int count = path_samples(record.solution.centre_velocity, h, scene.constraints.stride);
  record.state.qdot = record.solution.qdot;
  record.crossing = 0;
  for (int i = 1; i <= count; ++i) {
    const double t = i < count ? h * i / count : h;
    follow_path(model, scene, t, sim, record);
    if (i < count) {
      record.crossing = std::max(record.crossing, record.observation.penetration);
    }
    if (!correct) {
      continue;
    }
    std::vector<Row>& rows = record.solution.rows;
    bool missed = add_missed_rows(model, sim.observation, record.observation, t, scene,
                                  record.solution, rows);
    if (i == count) {
      missed = add_missed_bends(model, sim.state.q, record.state.q, scene, rows) || missed;
    }
    if (missed) {
      return true;
    }
  }
  return false;
}

/// A step whose path still overlaps ends where strands meet: the rest of its motion is left out,
/// and the next step, with strands close, can see and stop them. The time travelled, s.
double end_where_strands_meet(const Model& model, const Scene& scene, Simulation& sim,
                              StepRecord& record) {
  constexpr int least_samples = 16;
  const double h = scene.time.step;
  const double allowed =
      std::max(sim.observation.penetration, way_tolerance * scene.constraints.stride);
  if (std::max(record.crossing, record.observation.penetration) <= allowed) {
    return h;
  }
  const int count = std::max(
      least_samples, path_samples(record.solution.centre_velocity, h, scene.constraints.stride));
  const auto move_to = [&](int i) { follow_path(model, scene, h * i / count, sim, record); };
  int clear = 0;
  for (move_to(1); clear < count && record.observation.penetration <= allowed; move_to(clear + 1)) {
    ++clear;
  }
  move_to(clear);
  record.crossing = 0;
  report(StopCause::speed,
         fmt::format("strands meet too fast for the step, which ends there: {:.3g} s of its motion "
                     "are left out; a smaller time.step would help",
                     h * (count - clear) / count),
         GuardAction::warn, sim.watch, record.warnings);
  return h * clear / count;
}

void keep(Simulation& sim) {
  BeforeStep& before = sim.before;
  before.controller = sim.controller;
  before.warm = sim.warm;
  before.ledger = sim.ledger;
  before.watch = sim.watch;
  before.candidates = sim.search.candidates;
  before.moved = sim.search.moved;
}

void put_back(Simulation& sim) {
  const BeforeStep& before = sim.before;
  sim.controller = before.controller;
  sim.warm = before.warm;
  sim.ledger = before.ledger;
  sim.watch = before.watch;
  sim.search.candidates = before.candidates;
  sim.search.moved = before.moved;
  sim.search.segments = sim.observation.segments;
}

/// A step that may throw half way.
void try_step(const Model& model, const Scene& scene, BoxQpSolver& solver, Simulation& sim,
              StepRecord& record) {
  const double h = scene.time.step;
  record.step = sim.step;
  record.time = time_of(sim, scene);
  record.warnings.clear();
  decide(model, scene, sim.observation, record.time, sim.controller, record.control);
  if (!sim.controller.lost.empty()) {
    report(StopCause::knot_lost, sim.controller.lost, GuardAction::warn, sim.watch,
           record.warnings);
  }
  begin_step(model, sim.state, sim.observation, record.control, scene, solver, sim.warm,
             sim.scratch, record.solution);
  // The record's old state and observation are storage for the next ones; then they change places.
  const bool sees = scene.constraints.activation == Activation::speculative;
  int corrections = sees ? scene.constraints.corrections : 0;
  for (int k = 0; misses_rows(model, scene, k < corrections, sim, record); ++k) {
    try {
      resume_step(model, sim.state, sim.observation, scene, solver, sim.warm, sim.scratch,
                  record.solution);
    } catch (const StepError&) {  // the rows added cannot all be met: without them
      begin_step(model, sim.state, sim.observation, record.control, scene, solver, sim.warm,
                 sim.scratch, record.solution);
      corrections = 0;
    }
  }
  const double travelled = sees ? end_where_strands_meet(model, scene, sim, record) : h;
  finish_step(model, sim.observation, record.control, scene, sim.warm, sim.scratch,
              record.solution);
  guard_cap(model, sim.observation.kin, scene, record.solution, record.time, sim.watch,
            record.warnings);
  guard_state(model, record.state, record.observation, record.crossing, scene, sim.watch,
              record.warnings);

  record.ledger = sim.ledger;
  book_step(model, sim.observation.kin, record.solution, record.state, record.observation.kin, h,
            travelled, sim.ledger);
  guard_energy(model, scene, record.state, record.observation.kin, sim.ledger, sim.watch,
               record.warnings);
  record.head_drift = record.control.clamp_head ? head_drift(model, sim.observation.kin) : 0;
  record.controller = sim.controller;
  std::swap(record.state, sim.state);
  std::swap(record.observation, sim.observation);
  ++sim.step;
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
  observe(model, sim.state, scene, sim.search, sim.observation);
  sim.ledger = open_ledger(model, sim.state, sim.observation.kin);
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
  keep(sim);
  try {
    try_step(model, scene, solver, sim, record);
  } catch (...) {
    record.controller = sim.controller;
    put_back(sim);
    throw;
  }
}

StepRecord take_step(const Model& model, const Scene& scene, BoxQpSolver& solver, Simulation& sim) {
  StepRecord record;
  take_step(model, scene, solver, sim, record);
  return record;
}

}  // namespace hagfish
