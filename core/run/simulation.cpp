#include "core/run/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/chain/start.hpp"
#include "core/run/guard.hpp"
#include "core/step/look_ahead.hpp"

namespace hagfish {
namespace {

/// One step on its way from `sim.now` to `next`, which is the record's storage for a moment: the
/// two change places once, when the step has been taken.
class Attempt {
 public:
  Attempt(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record)
      : model_(model),
        scene_(scene),
        sim_(sim),
        record_(record),
        step_(record.solution),
        next_(record.moment),
        in_{model,          scene,
            sim.now.state,  sim.now.observation,
            record.control, scene.time.rule == TimeRule::euler ? nullptr : &sim.midway} {}

  Status take() {
    record_.step = sim_.step;
    record_.time = time_of(sim_, scene_);
    record_.warnings.clear();
    if (Status status = decide(model_, scene_, sim_.now, record_.time, sim_.law_storage,
                               sim_.controller, record_.control, sim_.law);
        !status.ok()) {
      return status;
    }
    if (!sim_.controller.lost.empty()) {
      warn(Outcome::knot_lost, sim_.controller.lost);
    }
    if (Status status = solve(); !status.ok()) {
      return status;
    }
    if (step_.unsettled > 0) {
      warn(
          Outcome::unsettled,
          fmt::format("after {} passes the middle of a step is known to {:.3g} rad/s or cm/s only, "
                      "over time.settled = {:g}; a smaller time.step would help",
                      step_.passes, step_.unsettled, scene_.time.settled));
    }
    const double travelled = looks_ahead() ? end_where_strands_meet() : h();
    sim_.solver.finish(in_, step_);
    note_pull(step_, sim_.controller);
    guard_muscles(model_, scene_, record_.control, record_.time, sim_.watch, record_.warnings);
    guard_cap(model_, in_.kin(), scene_, sim_.controller.phase, step_, record_.time, sim_.watch,
              record_.warnings);
    if (Status status =
            guard_state(model_, next_, record_.crossing, scene_, sim_.watch, record_.warnings);
        !status.ok()) {
      return status;
    }
    record_.ledger = sim_.ledger;
    book_step(in_, step_, next_, travelled, sim_.ledger);
    if (Status status =
            guard_energy(model_, scene_, next_, sim_.ledger, sim_.watch, record_.warnings);
        !status.ok()) {
      return status;
    }
    record_.head_drift =
        record_.control.clamp_head ? head_drift(model_, sim_.now.observation.kin) : 0;
    record_.controller = sim_.controller;
    record_.momentum = sim_.momentum;
    book_momentum(in_, step_, next_, sim_.ledger, sim_.momentum);
    guard_momentum(model_, in_, record_.momentum, sim_.momentum, sim_.ledger, sim_.watch,
                   record_.warnings);
    std::swap(sim_.now, next_);
    ++sim_.step;
    return {};
  }

 private:
  double h() const { return scene_.time.step; }
  bool looks_ahead() const { return scene_.constraints.activation == Activation::speculative; }

  void warn(Outcome outcome, const std::string& message) {
    std::ignore = report(outcome, message, GuardAction::warn, sim_.watch, record_.warnings);
  }

  /// Solves the step, and again as long as its path misses rows, up to
  /// scene.constraints.corrections times. Where the rows added cannot all be met the step goes
  /// without them.
  Status solve() {
    Status status = sim_.solver.begin(in_, step_);
    int corrections = looks_ahead() ? scene_.constraints.corrections : 0;
    for (int k = 0; status.ok(); ++k) {
      status = guard_speed(step_.centre_velocity, scene_);
      if (!status.ok() || !follow_path(k < corrections)) {
        break;
      }
      status = sim_.solver.resume(in_, step_);
      if (!status.ok() && status.outcome != Outcome::stopped) {
        corrections = 0;
        status = sim_.solver.begin(in_, step_);
      }
    }
    return status;
  }

  /// Where the step's velocity leads within time `t` (s).
  void move(double t) {
    advance(sim_.now.state.q, step_.qdot, t, next_.state.q);
    if (keeps_momentum(scene_, record_.control)) {
      place_centre(model_, centre_after(in_, step_, sim_.momentum.momentum, t), next_.state.q,
                   next_.observation.kin);
      observe_placed(model_, next_.state, scene_, sim_.search, next_.observation);
    } else {
      observe(model_, next_.state, scene_, sim_.search, next_.observation);
    }
  }

  /// Moves along the step's path to its end. Where the path overlaps or leaves a cone and `correct`
  /// is set, adds the rows that show it and returns true: the step is to be solved again.
  bool follow_path(bool correct) {
    const int count = path_samples(step_.centre_velocity, h(), scene_.constraints.stride);
    next_.state.qdot = step_.next;
    record_.crossing = 0;
    for (int i = 1; i <= count; ++i) {
      const double t = i < count ? h() * i / count : h();
      move(t);
      if (i < count) {
        record_.crossing = std::max(record_.crossing, next_.observation.penetration);
      }
      if (!correct) {
        continue;
      }
      bool missed = add_missed_rows(in_, next_.observation, t, step_);
      if (i == count) {
        missed = add_missed_bends(in_, next_.state.q, step_) || missed;
      }
      if (missed) {
        return true;
      }
    }
    return false;
  }

  /// A step whose path still overlaps ends where strands meet: the rest of its motion is left out,
  /// and the next step, with strands close, can see and stop them. The time travelled, s.
  double end_where_strands_meet() {
    constexpr int least_samples = 16;
    const double allowed =
        std::max(sim_.now.observation.penetration, way_tolerance * scene_.constraints.stride);
    if (std::max(record_.crossing, next_.observation.penetration) <= allowed) {
      return h();
    }
    const int count = std::max(least_samples,
                               path_samples(step_.centre_velocity, h(), scene_.constraints.stride));
    const auto move_to = [&](int i) { move(h() * i / count); };
    int clear = 0;
    while (clear < count) {
      move_to(clear + 1);
      if (next_.observation.penetration > allowed) break;
      ++clear;
    }
    if (clear == count) return h();
    move_to(clear);
    record_.crossing = 0;
    warn(Outcome::speed,
         fmt::format("strands meet too fast for the step, which ends there: {:.3g} s of its motion "
                     "are left out; a smaller time.step would help",
                     h() * (count - clear) / count));
    return h() * clear / count;
  }

  const Model& model_;
  const Scene& scene_;
  Simulation& sim_;
  StepRecord& record_;
  StepSolution& step_;
  Moment& next_;
  StepInput in_;
};

void keep(Simulation& sim) {
  BeforeStep& before = sim.before;
  before.controller = sim.controller;
  before.warm = sim.solver.warm;
  before.ledger = sim.ledger;
  before.momentum = sim.momentum;
  before.watch = sim.watch;
  keep_candidates(sim.search.candidates, before.candidates);
}

void put_back(Simulation& sim) {
  const BeforeStep& before = sim.before;
  sim.controller = before.controller;
  sim.solver.warm = before.warm;
  sim.ledger = before.ledger;
  sim.momentum = before.momentum;
  sim.watch = before.watch;
  sim.search.candidates = before.candidates;
}

}  // namespace

Simulation start(const Model& model, const Scene& scene, const std::string& back_end) {
  ControllerState controller;
  controller.phase = scene.start.phase;
  return start_from(model, scene, back_end, start_state(model, scene.start), controller, 0);
}

Simulation start_from(const Model& model, const Scene& scene, const std::string& back_end,
                      State state, ControllerState controller, std::int64_t step) {
  StepSolver solver(
      back_end);  // before anything is moved: GCC 12 destroys that twice if this throws
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
  sim.ledger = open_ledger(model, sim.now);
  sim.momentum = open_momentum(model, sim.now);
  return sim;
}

void change_scene(const Model& model, const Scene& before, const Scene& scene, Simulation& sim) {
  if (sim.now.state.q.size() != model.nq()) {
    throw std::invalid_argument("the state is of a chain of another number of bodies");
  }
  const double frames = time_of(sim, before) / scene.time.frame_interval;
  constexpr double rounding = 1e-9;  // of a number of frames that is whole
  if (std::abs(frames - std::round(frames)) > rounding * std::max(1.0, frames)) {
    throw std::invalid_argument(
        fmt::format("its time, {:g} s, is no multiple of time.frame_interval, {:g} s",
                    time_of(sim, before), scene.time.frame_interval));
  }
  sim.step = std::llround(time_of(sim, before) / scene.time.step);
  if (scene.controller.law != before.controller.law) sim.controller.memory.resize(0);
  if (scene.script.kind != ScriptSettings::Kind::curvature &&
      scene.controller.law != LawName::own) {
    sim.controller.rest_shape.resize(0);
  }
  sim.search = {};
  observe(model, sim.now.state, scene, sim.search, sim.now.observation);
  const EnergyLedger now = open_ledger(model, sim.now);
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

void take_step(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record) {
  keep(sim);
  try {
    const Status status = Attempt(model, scene, sim, record).take();
    if (!status.ok()) {
      throw StepError({status.outcome, status.message + cure_of_torque(record.control, status)});
    }
  } catch (...) {
    record.controller = sim.controller;
    put_back(sim);
    throw;
  }
}

StepRecord take_step(const Model& model, const Scene& scene, Simulation& sim) {
  StepRecord record;
  take_step(model, scene, sim, record);
  return record;
}

}  // namespace hagfish
