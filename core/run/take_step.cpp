// One step of a run.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/run/simulation.hpp"
#include "core/step/look_ahead.hpp"

namespace hagfish {
namespace {

/// A step from `sim.now` to `record.after`. The two are swapped once the step is taken.
struct Attempt {
  const StepInput in;
  Simulation& sim;
  StepRecord& record;

  double h() const { return in.scene.time.step; }
  StepPlace place() const { return sim.solver.place(in); }
  /// Velocity of the one who watches the path, cm/s: who moves with a body that nothing holds and
  /// no obstacle may stop, else who stands.
  Eigen::Vector3d observer() const {
    if (in.control.clamp_head || !in.model.obstacles.empty()) return Eigen::Vector3d::Zero();
    return mean_by_mass(in.model, record.solution.centre_velocity);
  }
  int samples() const {
    return path_samples(record.solution.centre_velocity, observer(), h(),
                        in.scene.constraints.stride);
  }
  void warn(Outcome outcome, const std::string& message) const {
    std::ignore = report(outcome, message, GuardAction::warn, sim.watch, record.warnings);
  }
  void require(const Status& status) const {
    if (status.ok()) return;
    throw StepError({status.outcome, status.message + cure_of_torque(record.control, status)});
  }
};

bool looks_ahead(const Scene& scene) {
  return scene.constraints.activation == Activation::speculative;
}

/// Decides what the animal does, by the controller and its law.
void decide_control(const Attempt& step) {
  const auto& [in, sim, record] = step;
  record.step = sim.step;
  record.time = time_of(sim, in.scene);
  record.warnings.clear();
  step.require(decide(in.model, in.scene, sim.now, record.time, sim.named_law, sim.controller,
                      record.control, sim.law));
  if (!sim.controller.lost.empty()) {
    step.warn(
        Outcome::knot_lost,
        sim.controller.lost +
            ". From here on the run does not show the scene's knot; try a smaller time.step, or "
            "another script or expect.knot");
  }
}

/// Eq. 2: moves by the step's velocity for the time `t` (s), and observes the state there.
void move(const Attempt& step, double t) {
  const auto& [in, sim, record] = step;
  auto& [state, observation] = record.after;
  advance(in.state.q, record.solution.qdot, t, state.q);
  if (keeps_momentum(in)) {
    place_centre(in.model,
                 centre_after(in, step.place(), record.solution, sim.momentum.momentum, t), state.q,
                 observation.kin);
    observe_placed(in.model, state, in.scene, sim.search, observation);
  } else {
    observe(in.model, state, in.scene, sim.search, observation);
  }
}

/// Moves along the step's path to its end. If the path overlaps or leaves a cone and `correct` is
/// set, returns rows for this, with which the step must be solved again.
std::vector<PathRow> look_along_path(const Attempt& step, bool correct) {
  const auto& [in, sim, record] = step;
  const StepSolution& solution = record.solution;
  ObservedState& there = record.after;
  const int count = step.samples();
  there.state.qdot = solution.next;
  record.crossing = 0;
  for (int i = 1; i <= count; ++i) {
    const double t = i < count ? step.h() * i / count : step.h();
    move(step, t);
    if (i < count) record.crossing = std::max(record.crossing, there.observation.penetration);
    if (!correct) continue;
    std::vector<PathRow> missed = missed_rows(in, step.place(), there.observation, t, solution);
    if (i == count) {
      std::ranges::copy(missed_bends(in, there.state.q, solution), std::back_inserter(missed));
    }
    if (!missed.empty()) return missed;
  }
  return {};
}

/// Solves the step, and solves it again while its path shows missing rows, up to
/// scene.constraints.corrections times. If the added rows contradict each other, the step is taken
/// without them.
void solve_along_path(const Attempt& step) {
  const auto& [in, sim, record] = step;
  StepSolution& solution = record.solution;
  int corrections = looks_ahead(in.scene) ? in.scene.constraints.corrections : 0;
  Status status = sim.solver.begin(in, solution);
  for (int k = 0; status.ok(); ++k) {
    status = guard_speed(solution.centre_velocity, step.observer(), in.scene);
    if (!status.ok()) break;
    const std::vector<PathRow> missed = look_along_path(step, k < corrections);
    if (missed.empty()) break;
    status = sim.solver.resume(in, missed, solution);
    if (!status.ok() && status.outcome != Outcome::stopped) {
      corrections = 0;
      status = sim.solver.begin(in, solution);
    }
  }
  step.require(status);
  if (solution.middle.unsettled > 0) {
    step.warn(
        Outcome::unsettled,
        fmt::format(
            "after {} passes velocities in the middle of a step still change by {:.3g} rad/s or "
            "cm/s, over time.settled = {:g}. The run can be used, but its errors are larger "
            "than those of the midpoint rule; try a smaller time.step",
            solution.middle.passes, solution.middle.unsettled, in.scene.time.settled));
  }
}

/// Ends a step whose path still overlaps where the strands meet. The rest of its motion is left
/// out, and the next step, with strands close, can see and stop them. Flesh may overlap. Returns
/// the time travelled, s.
double end_where_strands_meet(const Attempt& step) {
  const auto& [in, sim, record] = step;
  const double stride = in.scene.constraints.stride;
  constexpr int least_samples = 16;
  const double& penetration = record.after.observation.penetration;
  const int samples = step.samples();
  const double before = in.observation.penetration;
  const double allowed = std::max(before, way_tolerance * stride);
  // The largest overlap that corrections leave, and half of an earlier overlap. On a long path,
  // whose rows ask for too little (missed_rows), there may be more.
  const double left = samples > 1 ? std::max(before, 3 * in.scene.constraints.tolerance) : allowed;
  if (in.scene.flesh.present() || !looks_ahead(in.scene) ||
      (record.crossing <= allowed && penetration <= left)) {
    return step.h();
  }
  const int count = std::max(least_samples, samples);
  int clear = 0;
  while (clear < count) {
    move(step, step.h() * (clear + 1) / count);
    if (penetration > left) break;
    ++clear;
  }
  if (clear == count) return step.h();
  move(step, step.h() * clear / count);
  record.crossing = 0;
  step.warn(
      Outcome::speed,
      fmt::format(
          "strands meet too fast for time.step, so the step ends where they meet and its last "
          "{:.3g} s are left out. The run can be used, except speeds at this time; try a "
          "smaller time.step",
          step.h() * (count - clear) / count));
  return step.h() * clear / count;
}

/// The guards of the step and of the state after it.
void watch(const Attempt& step) {
  const auto& [in, sim, record] = step;
  guard_muscles(in.model, in.scene, in.control, record.time, sim.watch, record.warnings);
  guard_cap(in.model, step.place().kin, in.scene, sim.controller.phase, record.solution,
            record.time, sim.watch, record.warnings);
  step.require(
      guard_state(in.model, record.after, record.crossing, in.scene, sim.watch, record.warnings));
  record.head_drift = record.control.clamp_head ? head_drift(in.model, in.observation.kin) : 0;
}

/// The ledger of energy, which may not grow by itself, and the ledger of momentum, after a motion
/// for the time `travelled` (s).
void book(const Attempt& step, double travelled) {
  const auto& [in, sim, record] = step;
  ObservedState& next = record.after;
  record.ledger = sim.ledger;
  book_step(in, step.place(), record.solution, next, travelled, sim.ledger);
  const double passing = passing_momentum(in, record.solution);
  step.require(guard_energy(in, passing, next, sim.ledger, sim.watch, record.warnings));
  record.momentum = sim.momentum;
  book_momentum(in, step.place(), record.solution, next, sim.ledger, sim.momentum);
  guard_momentum(in, passing, record.momentum, sim.momentum, sim.ledger, sim.watch,
                 record.warnings);
}

/// Marks a step as under way, so that there is only one at a time.
class OneStepAtATime {
 public:
  explicit OneStepAtATime(StepUnderWay& under_way) : under_way_(under_way) {
    if (!under_way.begin()) {
      throw std::logic_error(
          "this simulation is already taking a step; take the other step in a copy of it");
    }
  }
  ~OneStepAtATime() { under_way_.end(); }
  OneStepAtATime(const OneStepAtATime&) = delete;
  OneStepAtATime& operator=(const OneStepAtATime&) = delete;

 private:
  StepUnderWay& under_way_;
};

/// What a step changes before it is certain to be taken, as in BeforeStep.
auto changed_by_step(Simulation& sim) {
  return std::tie(sim.controller, sim.solver.warm, sim.ledger, sim.momentum, sim.watch,
                  sim.search.candidates);
}

}  // namespace

void take_step(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record) {
  require_of(model, sim);
  const OneStepAtATime only(sim.under_way);
  const Attempt step{
      {model, scene, sim.now.state, sim.now.observation, record.control}, sim, record};
  sim.before = changed_by_step(sim);
  try {
    decide_control(step);
    solve_along_path(step);
    const double travelled = end_where_strands_meet(step);
    record.left_out = step.h() - travelled;
    sim.solver.finish(step.in, record.solution);
    note_pull(record.solution, sim.controller);
    watch(step);
    book(step, travelled);
  } catch (...) {
    record.controller = sim.controller;
    changed_by_step(sim) = sim.before;
    throw;
  }
  record.controller = sim.controller;
  std::swap(sim.now, record.after);
  ++sim.step;
}

}  // namespace hagfish
