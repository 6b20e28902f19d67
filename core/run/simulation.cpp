#include "core/run/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/chain/start.hpp"

namespace hagfish {
namespace {

void require_bodies(const Model& model) {
  if (model.bodies.empty()) throw std::invalid_argument("the model has no bodies");
}

void require_of(const Model& model, const State& state) {
  if (state.q.size() == model.nq() && state.qdot.size() == model.nv()) return;
  throw std::invalid_argument("the state has another number of bodies than the model");
}

}  // namespace

void require_of(const Model& model, const Simulation& sim) {
  require_of(model, sim.now.state);
  if (sim.now.observation.kin.centre.cols() != model.body_count()) {
    throw std::invalid_argument("the kinematics of the state are those of another model");
  }
}

Simulation start(const Model& model, const Scene& scene, const std::string& back_end) {
  require_bodies(model);
  ControllerState controller;
  controller.phase = scene.start.phase;
  return start_from(model, scene, back_end, start_state(model, scene.start), controller, 0);
}

Simulation start_from(const Model& model, const Scene& scene, const std::string& back_end,
                      State state, ControllerState controller, std::int64_t step) {
  require_bodies(model);
  require_of(model, state);
  StepSolver solver(
      back_end);  // before any move: if this throws, GCC 12 destroys moved objects twice
  Simulation sim{.step = step,
                 .now = {std::move(state), {}},
                 .search = {},
                 .controller = std::move(controller),
                 .solver = std::move(solver),
                 .ledger = {},
                 .momentum = {},
                 .watch = {},
                 .before = {}};
  observe(model, sim.now.state, scene, sim.search, sim.now.observation);
  sim.ledger =
      open_ledger(model, sim.now, keeps_momentum(scene, clamps_head(scene, sim.controller.phase)));
  sim.momentum = open_momentum(model, sim.now);
  return sim;
}

void change_scene(const Model& model, const Scene& before, const Scene& scene, Simulation& sim) {
  require_of(model, sim);
  const double frames = time_of(sim, before) / scene.time.frame_interval;
  constexpr double rounding = 1e-9;  // of a number of frames that is whole
  if (std::abs(frames - std::round(frames)) > rounding * std::max(1.0, frames)) {
    throw std::invalid_argument(
        fmt::format("its time, {:g} s, is not a multiple of time.frame_interval = {:g} s",
                    time_of(sim, before), scene.time.frame_interval));
  }
  sim.step = std::llround(time_of(sim, before) / scene.time.step);
  if (scene.controller.law != before.controller.law) sim.controller.memory.resize(0);
  if (scene.script.kind != ScriptSettings::Kind::curvature && scene.controller.law != own_law) {
    sim.controller.rest_shape.resize(0);
  }
  sim.search = {};
  observe(model, sim.now.state, scene, sim.search, sim.now.observation);
  const EnergyLedger now =
      open_ledger(model, sim.now, keeps_momentum(scene, clamps_head(scene, sim.controller.phase)));
  const Momentum now_momentum = open_momentum(model, sim.now).momentum;
  EnergyLedger& ledger = sim.ledger;
  ledger.initial += now.initial - (ledger.kinetic + ledger.elastic + ledger.gravity);
  ledger.kinetic = now.kinetic;
  ledger.elastic = now.elastic;
  ledger.gravity = now.gravity;
  ledger.largest = std::max(ledger.largest, now.largest);
  sim.momentum.initial += now_momentum - sim.momentum.momentum;
  sim.momentum.momentum = now_momentum;
}

bool finished(const Simulation& sim, const Scene& scene) {
  // Half a step of slack: the time of a step is a product and may fall short by rounding.
  const double time = time_of(sim, scene) + 0.5 * scene.time.step;
  return time >= scene.time.duration ||
         phase_order(sim.controller.phase) > phase_order(scene.time.until) ||
         (sim.controller.phase == Phase::free &&
          time >= sim.controller.phase_start + scene.controller.free_time);
}

StepRecord take_step(const Model& model, const Scene& scene, Simulation& sim) {
  StepRecord record;
  take_step(model, scene, sim, record);
  return record;
}

}  // namespace hagfish
