#include "core/simulation.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "core/start.hpp"

namespace hagfish {
namespace {

/// Stops a run whose state is beyond anything the scene can mean.
void guard(const Model& model, const Situation& situation, const GuardSettings& limits) {
  if (!situation.kin.centre.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite state");
  }
  if (situation.penetration > limits.penetration) {
    throw StepError(StopCause::penetration,
                    fmt::format("penetration {:.3g} cm exceeds guard.penetration = {:g} cm",
                                situation.penetration, limits.penetration));
  }
  if (situation.limit_violation > limits.limit_violation) {
    constexpr double degree = std::numbers::pi / 180;
    throw StepError(
        StopCause::limits,
        fmt::format("a joint is {:.3g} deg past its limit, over guard.limit_violation_deg = {:g}",
                    situation.limit_violation / degree, limits.limit_violation / degree));
  }
  for (int b = 0; b < model.body_count(); ++b) {
    const double speed = situation.kin.centre_velocity.col(b).norm();
    if (!(speed <= limits.speed)) {
      throw StepError(StopCause::speed,
                      fmt::format("body {} moves at {:.3g} cm/s, over guard.speed = {:g} cm/s", b,
                                  speed, limits.speed));
    }
  }
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
         (sim.controller.phase == Phase::free &&
          time >= sim.controller.phase_start + scene.controller.free_time);
}

void take_step(const Model& model, const Scene& scene, BoxQpSolver& solver, Simulation& sim,
               StepRecord& record) {
  const double h = scene.time.step;
  record.step = sim.step;
  record.time = time_of(sim, scene);
  decide(model, scene, sim.situation, record.time, sim.controller, record.control);
  solve_step(model, sim.state, sim.situation, record.control, scene, solver, sim.warm, sim.scratch,
             record.solution);

  // The record's old state and situation are storage for the next ones; then they change places.
  advance(sim.state.q, record.solution.qdot, h, record.state.q);
  record.state.qdot = record.solution.qdot;
  observe(model, record.state, scene, sim.search, record.situation);
  guard(model, record.situation, scene.guard);

  record.ledger = sim.ledger;
  book_step(model, sim.situation.kin, record.solution, record.state, record.situation.kin, h,
            sim.ledger);
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
