#include "core/control/controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/knot/knot.hpp"

namespace hagfish {
namespace {

// A script that has not tied the knot within this share of its duration after its end has failed.
constexpr double patience = 0.4;

void enter(ControllerState& controller, Phase phase, double time) {
  controller.phase = phase;
  controller.phase_start = time;
}

/// Notes the present knot type, and since when it has been there.
void look_at_knot(const Scene& scene, const Observation& observation, double time,
                  ControllerState& controller) {
  const KnotInvariants before = controller.knot.type;
  controller.knot_seen = time;
  controller.knot = knot_type(observation.kin.centre, scene.knot);
  if (controller.knot.type != before) {
    if (before != KnotInvariants{}) controller.past = {before, controller.knot_from, time};
    controller.knot_from = time;
  }
}

/// "a knot (overhand, 3_1), tied since 8.64 s", or "no knot" with the last knot before.
std::string knot_seen_text(const ControllerState& controller) {
  if (controller.knot.type != KnotInvariants{}) {
    return fmt::format("{}, tied since {:.2f} s", a_knot(knot_name(controller.knot.type)),
                       controller.knot_from);
  }
  const PastKnot& past = controller.past;
  if (past.type == KnotInvariants{}) return "no knot (none was tied before)";
  return fmt::format("no knot (there was {} from {:.2f} to {:.2f} s)", a_knot(knot_name(past.type)),
                     past.from, past.to);
}

/// The status of a script that ended without what the scene expects: the knot, and enough tail
/// through it.
Status failed_script(const Scene& scene, const ControllerState& controller, double through) {
  if (knot_name(controller.knot.type) != scene.expect.knot) {
    return {Outcome::never_tied, fmt::format("the script ended with {}, but expect.knot = {}",
                                             knot_seen_text(controller), scene.expect.knot)};
  }
  return {Outcome::never_tied,
          fmt::format("the script ended with {}, but only {:.2f} cm of tail is through it; "
                      "controller.tail_through = {:g} cm",
                      knot_seen_text(controller), through, scene.controller.tail_through)};
}

/// Phase changes that follow from the present knot type.
Status switch_by_knot(const Model& model, const Scene& scene, double time,
                      ControllerState& controller) {
  const std::optional<KnotInvariants> wanted = knot_called(scene.expect.knot);
  const bool tied = wanted && controller.knot.type == *wanted;
  if (controller.phase == Phase::form) {
    const std::optional<KnotSpan> span = knot_span(controller);
    const double through = span ? model.length() - span->tail_end : 0;
    if (tied && span && through >= scene.controller.tail_through &&
        time >= scene.controller.tighten_from) {
      enter(controller, Phase::tighten, time);
    } else if (wanted && scene.script.kind != ScriptSettings::Kind::none &&
               time > (1 + patience) * script_end(scene.script)) {
      return failed_script(scene, controller, through);
    }
  } else if (holds_knot(controller.phase) && !tied) {
    const std::string message =
        fmt::format("the {} was lost: now {}", scene.expect.knot, knot_seen_text(controller));
    if (scene.guard.action == GuardAction::stop) return {Outcome::knot_lost, message};
    controller.lost = message;
  } else if (controller.phase == Phase::release && controller.knot.type == KnotInvariants{} &&
             time + 0.5 * scene.time.step >= controller.knot_from + scene.controller.untied_for) {
    enter(controller, Phase::free, time);
  }
  return {};
}

/// Phase changes that follow from where the knot is.
void switch_by_span(const Model& model, const Scene& scene, double time,
                    ControllerState& controller) {
  const std::optional<KnotSpan> span = knot_span(controller);
  const ControllerSettings& settings = scene.controller;
  if (controller.phase == Phase::form || !span ||
      span->tail_end - span->head_end > settings.tight_span) {
    controller.loose = time;
  }
  if (controller.phase == Phase::tighten &&
      (time - controller.loose >= settings.tight_hold ||
       time - controller.phase_start >= settings.tighten_time)) {
    enter(controller, Phase::slide, time);
  }
  if (controller.phase == Phase::slide && span && span->head_end <= settings.release_at) {
    enter(controller,
          scene.food.hold > 0                  ? Phase::pull
          : settings.leave_by == BodyEnd::head ? Phase::release
                                               : Phase::reverse,
          time);
    controller.pull = {};
  }
  if (controller.phase == Phase::reverse && span &&
      model.length() - span->tail_end <= settings.release_at) {
    enter(controller, Phase::release, time);
  }
}

/// The food tears off when a mean of the pull exceeds its strength. Means end at whole multiples of
/// their duration. The first one counts only if it lies within the pull.
bool food_gives(const Scene& scene, double time, PullSum& pull) {
  const double h = scene.time.step;
  const double window = std::max(1.0, std::round(scene.food.average / h));  // in steps
  if (std::fmod(std::round(time / h), window) != 0) return false;
  const bool gives =
      pull.steps == window && pull.sum > scene.food.strength * dyn_per_newton * pull.steps;
  pull = {};
  return gives;
}

}  // namespace

std::optional<KnotSpan> knot_span(const ControllerState& controller) {
  if (!controller.ends.first || !controller.ends.last) return std::nullopt;
  return KnotSpan{controller.ends.head_end, controller.ends.tail_end};
}

bool clamps_head(const Scene& scene, Phase phase) {
  return scene.clamp_head && phase_order(phase) < phase_order(scene.controller.free_from);
}

void note_pull(const StepSolution& step, ControllerState& controller) {
  if (controller.phase == Phase::pull) {
    controller.pull.sum += pull_of(step.force[RowKind::head]);
    ++controller.pull.steps;
  }
}

Status follow(const Model& model, const Scene& scene, const ObservedState& now, double time,
              ControllerState& controller) {
  const Observation& observation = now.observation;
  controller.ends = observation.ends;
  // Half a step of slack: the time of a step is a product and may fall short by rounding.
  if (controller.phase != Phase::free &&
      time + 0.5 * scene.time.step >= controller.knot_seen + scene.knot.interval) {
    look_at_knot(scene, observation, time, controller);
    if (Status status = switch_by_knot(model, scene, time, controller); !status.ok()) return status;
  }
  switch_by_span(model, scene, time, controller);
  // Half a step of slack, as above.
  if (controller.phase == Phase::pull &&
      (food_gives(scene, time, controller.pull) ||
       time + 0.5 * scene.time.step >= controller.phase_start + scene.food.hold)) {
    enter(controller, Phase::release, time);
  }
  return {};
}

void command(const Model& model, const Scene& scene, const ObservedState& now, double time,
             const ControlLaw& own, NamedLaw& named, ControllerState& controller,
             Control& control) {
  control.clamp_head = clamps_head(scene, controller.phase);
  control.tip = {};
  control.thigmotaxis.clear();
  control.torque.value.setZero();
  control.torque.rate.setZero();
  control.rest_shape = controller.rest_shape;
  const Situation at{model, scene, now, time, controller};
  if (!fits_law(model, scene, controller.memory)) controller.memory.resize(0);
  if (!own) {
    ask_law(at, controller.memory, control, named);
  } else if (scene.controller.law == own_law) {
    own(at, controller.memory, control);
  } else {
    throw std::invalid_argument(
        R"(the program sets a control law, so controller.law must be "own")");
  }
  if (control.torque.rate.size() == 0) control.torque.rate.setZero(control.torque.value.size());
  check_control(model, control);
  controller.rest_shape = control.rest_shape;
  if (control.rest_shape.size() > 0) {
    active_torque(model, scene.active, now.state, control.rest_shape, scene.time.reach(),
                  control.active);
  } else {
    control.active = {};
  }
  control.torque.saturated = -1;
  if (scene.active.bounds_laws) {
    bound_torque(scene.active.capacity, now.state.qdot, control.active, control.torque);
  }
}

Status decide(const Model& model, const Scene& scene, const ObservedState& now, double time,
              NamedLaw& named, ControllerState& controller, Control& control,
              const ControlLaw& own) {
  Status status = follow(model, scene, now, time, controller);
  if (status.ok()) command(model, scene, now, time, own, named, controller, control);
  return status;
}

}  // namespace hagfish
