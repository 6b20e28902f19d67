#include "core/controller.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

// Minima of the gap hop along a contact line from one universal joint to the next, 0.85 cm at 100
// bodies, and slide by 0.004 cm a step in between. Half a centimetre tells the two apart, cm.
constexpr double same_contact = 0.5;
// A script that has not tied within this long after its last knot will not, s.
constexpr double patience = 2.0;

double apart(const Contact& x, const Contact& y) {
  return std::hypot(x.arc_a - y.arc_a, x.arc_b - y.arc_b);
}

/// One step of a tracked contact: it goes on as the outermost one where that is the same, else as
/// the nearest minimum, else as the same material points, for the hysteresis time at most.
void follow(TrackedContact& tracked, const Situation& situation, const Contact* outermost,
            double time, double hysteresis) {
  if (outermost == nullptr) {
    tracked = {};
    return;
  }
  if (!tracked.contact || apart(*outermost, *tracked.contact) < same_contact ||
      time - tracked.settled >= hysteresis) {
    tracked = {*outermost, time};
    return;
  }
  const std::vector<Contact>& contacts = situation.contact.contacts;
  const Contact& old = *tracked.contact;
  const auto nearest = std::min_element(
      contacts.begin(), contacts.end(),
      [&](const Contact& x, const Contact& y) { return apart(x, old) < apart(y, old); });
  tracked.contact =
      apart(*nearest, old) < same_contact
          ? *nearest
          : contact_at(situation.segments, old.segment_a, old.t_a, old.segment_b, old.t_b);
}

void follow_contacts(const Scene& scene, const Situation& situation, double time,
                     ControllerState& controller) {
  const std::vector<Contact>& contacts = situation.contact.contacts;
  const Contact* first = nullptr;
  const Contact* last = nullptr;
  for (const Contact& contact : contacts) {
    if (contact.gap > scene.controller.contact_gap) {
      continue;
    }
    if (first == nullptr || contact.arc_a < first->arc_a) {
      first = &contact;
    }
    if (last == nullptr || contact.arc_b > last->arc_b) {
      last = &contact;
    }
  }
  follow(controller.first, situation, first, time, scene.controller.hysteresis);
  follow(controller.last, situation, last, time, scene.controller.hysteresis);
}

void enter(ControllerState& controller, Phase phase, double time) {
  controller.phase = phase;
  controller.phase_start = time;
}

/// Phase changes that follow from the knot type just seen.
void switch_by_knot(const Model& model, const Scene& scene, double time,
                    ControllerState& controller) {
  const bool knotted = controller.knot.type != KnotInvariants{};
  const std::optional<KnotSpan> span = knot_span(controller);
  switch (controller.phase) {
    case Phase::form:
      if (knotted && span && model.length() - span->tail_end >= scene.controller.tail_through) {
        enter(controller, Phase::tighten, time);
      } else if (scene.script.kind != ScriptSettings::Kind::none && !knotted &&
                 time > script_end(scene.script) + patience) {
        throw StepError(StopCause::never_tied, "the script ended untied");
      }
      break;
    case Phase::tighten:
    case Phase::slide:
      if (!knotted) {
        throw StepError(StopCause::knot_lost, "the knot came undone before the head was free");
      }
      break;
    case Phase::release:
      if (!knotted) {
        enter(controller, Phase::free, time);
      }
      break;
    case Phase::free:
      break;
  }
}

/// Phase changes that follow from where the knot is.
void switch_by_span(const Scene& scene, double time, ControllerState& controller) {
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
    enter(controller, Phase::release, time);
  }
}

}  // namespace

const char* phase_name(Phase phase) {
  constexpr const char* names[phase_count] = {"form", "tighten", "slide", "release", "free"};
  return names[static_cast<int>(phase)];
}

std::optional<KnotSpan> knot_span(const ControllerState& controller) {
  if (!controller.first.contact || !controller.last.contact) {
    return std::nullopt;
  }
  return KnotSpan{controller.first.contact->arc_a, controller.last.contact->arc_b};
}

void decide(const Model& model, const Scene& scene, const Situation& situation, double time,
            ControllerState& controller, Control& control) {
  follow_contacts(scene, situation, time, controller);
  // Half a step of slack: the time of a step is a product and may fall short by rounding.
  if (controller.phase != Phase::free &&
      time + 0.5 * scene.time.step >= controller.knot_seen + scene.knot.interval) {
    controller.knot_seen = time;
    controller.knot = knot_type(situation.kin.centre, scene.knot.votes, scene.knot.seed);
    switch_by_knot(model, scene, time, controller);
  }
  switch_by_span(scene, time, controller);

  control.tip = {};
  control.thigmotaxis.clear();
  control.clamp_head = scene.clamp_head && controller.phase < Phase::release;
  const int last = model.body_count() - 1;
  const Kinematics& kin = situation.kin;
  const ControllerSettings& settings = scene.controller;
  if (controller.phase == Phase::form) {
    control.tip = script_force(scene.script, time, scene.time.step, kin.centre.col(last),
                               kin.centre_velocity.col(last));
  } else if (controller.phase != Phase::free && controller.first.contact) {
    const bool tighten = controller.phase == Phase::tighten;
    control.thigmotaxis.push_back(
        {*controller.first.contact, tighten ? settings.tighten_head : settings.slide_head});
    control.thigmotaxis.push_back(
        {*controller.last.contact, tighten ? settings.tighten_tail : settings.slide_tail});
  }
}

}  // namespace hagfish
