// The paper's law (3.2), and the same at all contacts.
#include "core/control/controller.hpp"
#include "core/control/laws.hpp"

namespace hagfish {
namespace {

/// Whether the knot leaves, or has left, by the tail in this phase.
bool goes_back(const Situation& at) {
  const Phase phase = at.so_far.phase;
  return phase == Phase::reverse ||
         (phase == Phase::release && at.scene.controller.leave_by == BodyEnd::tail);
}

/// Speeds of the strands at the first and the last contact, and the end to slide to.
struct CommandedSpeeds {
  ThigmotaxisSpeeds first, last;
  BodyEnd towards;
};

CommandedSpeeds commanded_speeds(const Situation& at) {
  const ControllerSettings& settings = at.scene.controller;
  if (at.so_far.phase == Phase::tighten) {
    return {settings.tighten_head, settings.tighten_tail, BodyEnd::head};
  }
  return goes_back(at)
             ? CommandedSpeeds{settings.reverse_head, settings.reverse_tail, BodyEnd::tail}
             : CommandedSpeeds{settings.slide_head, settings.slide_tail, BodyEnd::head};
}

/// Eq. 6 at the first and the last contact.
void command_ends(const Situation& at, std::vector<ThigmotaxisCommand>& commands) {
  const ControllerSettings& settings = at.scene.controller;
  const ControllerState& so_far = at.so_far;
  const double effort = so_far.phase == Phase::pull
                            ? at.scene.food.cap.at(at.time - so_far.phase_start) / settings.cap
                            : 1;
  const CommandedSpeeds speeds = commanded_speeds(at);
  const auto command = [&](const Contact& contact, const ThigmotaxisSpeeds& speed, KnotEnd end) {
    commands.push_back({contact, speed, speeds.towards, effort, end, settings.eq6_slip});
  };
  command(*so_far.ends.first, speeds.first, KnotEnd::first);
  command(*so_far.ends.last, speeds.last, KnotEnd::last);
}

}  // namespace

void paper_law(const Situation& at, Control& control) {
  const auto& [model, scene, now, time, so_far] = at;
  const int last = model.body_count() - 1;
  const Kinematics& kin = now.observation.kin;
  if (so_far.phase == Phase::form) {
    control.tip = script_force(scene.script, time, scene.time, kin.centre.col(last),
                               kin.centre_velocity.col(last));
  } else if (so_far.phase != Phase::free && so_far.ends.first) {
    command_ends(at, control.thigmotaxis);
  }
  if (scene.script.kind == ScriptSettings::Kind::curvature) {
    move_rest_shape(model, scene, so_far.phase, now.state.q, time, control.rest_shape);
  }
}

void all_contacts_law(const Situation& at, Control& control) {
  paper_law(at, control);
  if (control.thigmotaxis.empty() || at.so_far.phase == Phase::tighten) return;
  const ThigmotaxisCommand first = control.thigmotaxis[0];
  const Contact last = control.thigmotaxis[1].contact;  // a copy: the list grows below
  const ThigmotaxisSpeeds speed = commanded_speeds(at).first;
  for (const Contact& contact : at.now.observation.contact.contacts) {
    if (contact.gap > at.scene.controller.contact_gap || contact.same_segments(first.contact) ||
        contact.same_segments(last)) {
      continue;
    }
    control.thigmotaxis.push_back(
        {contact, speed, first.towards, first.effort, KnotEnd::neither, Eq6Slip::shape});
  }
}

extern constinit const Law paper_record{
    .name = "paper",
    .description = "Eq. 6 at the first and the last contact, at the commanded speeds",
    .make =
        [] {
          return ControlLaw([](const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
            paper_law(at, control);
          });
        },
    .logs_rows = false};

extern constinit const Law all_contacts_record{
    .name = "all_contacts",
    .description = "Eq. 6 at every contact, as a knot that keeps its shape slides",
    .make = [] {
      return ControlLaw([](const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
        all_contacts_law(at, control);
      });
    }};

}  // namespace hagfish
