#include "core/control/control_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/control/controller.hpp"
#include "core/control/laws.hpp"

namespace hagfish {
namespace {

/// The memory of knot_speed_law.
constexpr Eigen::Index knot_speed_memory = 2;

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

bool same_segments(const Contact& x, const Contact& y) {
  return x.segment_a == y.segment_a && x.segment_b == y.segment_b;
}

void check_torque(const Model& model, const char* name, const Eigen::VectorXd& v) {
  if (v.size() != 0 && v.size() != model.nv()) {
    throw std::invalid_argument(
        fmt::format("control: {} has {} numbers, but the animal has {} velocities", name, v.size(),
                    model.nv()));
  }
  if (!v.allFinite()) {
    throw std::invalid_argument(fmt::format("control: {} holds a number that is not finite", name));
  }
  if (v.size() > 0 && !v.head<root_dofs>().isZero(0)) {
    throw std::invalid_argument(fmt::format(
        "control: {} acts on the root: its first {} numbers must be 0", name, root_dofs));
  }
}

void check_command(const Model& model, const ThigmotaxisCommand& command) {
  const Contact& c = command.contact;
  const int segments = model.body_count() - 1;
  const auto on_body = [segments](int segment, double t) {
    return segment >= 0 && segment < segments && t >= 0 && t <= 1;
  };
  constexpr double rounding = 1e-9;  // of a unit vector
  const auto unit = [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) <= rounding; };
  if (!on_body(c.segment_a, c.t_a) || !on_body(c.segment_b, c.t_b) || !unit(c.tangent_a) ||
      !unit(c.tangent_b)) {
    throw std::invalid_argument(
        "control: a command of Eq. 6 is at a contact that is not on the body");
  }
  if (!std::isfinite(command.speed.a) || !std::isfinite(command.speed.b) ||
      !std::isfinite(command.effort) || command.effort < 0) {
    throw std::invalid_argument(fmt::format(
        "control: a command of Eq. 6 at bodies {} and {}: speeds {:g} and {:g} cm/s and effort "
        "{:g} must be finite, and the effort not negative",
        c.body_a(), c.body_b(), command.speed.a, command.speed.b, command.effort));
  }
}

std::optional<SceneFault> knot_speed_fault(const Specimen& /*specimen*/, const Scene& scene) {
  const KnotSpeedSettings& loop = scene.controller.knot_speed;
  for (const auto& [key, value] :
       {std::pair("target", loop.target), {"gain", loop.gain}, {"filter", loop.filter}}) {
    if (value == 0) {
      return SceneFault{"controller.knot_speed." + std::string(key),
                        "must be positive where controller.law = \"knot_speed\""};
    }
  }
  return {};
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
  if (control.thigmotaxis.empty() || at.so_far.phase == Phase::tighten) {
    return;
  }
  const ThigmotaxisCommand first = control.thigmotaxis[0];
  const Contact last = control.thigmotaxis[1].contact;  // a copy: the list grows below
  const ThigmotaxisSpeeds speed = commanded_speeds(at).first;
  for (const Contact& contact : at.now.observation.contact.contacts) {
    if (contact.gap > at.scene.controller.contact_gap || same_segments(contact, first.contact) ||
        same_segments(contact, last)) {
      continue;
    }
    control.thigmotaxis.push_back(
        {contact, speed, first.towards, first.effort, KnotEnd::neither, Eq6Slip::shape});
  }
}

void knot_speed_law(const Situation& at, Eigen::VectorXd& memory, Control& control) {
  paper_law(at, control);
  if (at.so_far.phase != Phase::slide || control.thigmotaxis.empty()) {
    return;
  }
  const KnotSpeedSettings& loop = at.scene.controller.knot_speed;
  const double h = at.scene.time.step;
  const double arc = control.thigmotaxis[0].contact.arc_a;
  const double kept = std::exp(-h / loop.filter);
  const double lag = h / (1 - kept);  // of the smoothed place of the last step, at steady speed, s
  if (memory.size() == 0) {
    memory.resize(knot_speed_memory);
    memory << arc + lag * loop.target, 1;
  }
  double& smooth = memory[0];
  double& scale = memory[1];
  const double speed = (smooth - arc) / lag;  // towards the head
  smooth = arc + kept * (smooth - arc);
  scale = std::clamp(scale + h * loop.gain * (1 - speed / loop.target), 0.0, loop.most);
  for (ThigmotaxisCommand& command : control.thigmotaxis) {
    command.speed.a *= scale;
    command.speed.b *= scale;
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

extern constinit const Law knot_speed_record{
    .name = "knot_speed",
    .description = "the paper's, its speeds scaled until the knot has the speed wanted",
    .make = [] { return ControlLaw(knot_speed_law); },
    .memory_size = [](const Model& /*model*/, const Scene& /*scene*/) { return knot_speed_memory; },
    .fault = knot_speed_fault};

std::string cure_of_torque(const Control& control, const Status& status) {
  const bool blown_up = status.outcome == Outcome::speed || status.outcome == Outcome::non_finite ||
                        status.outcome == Outcome::energy_gain ||
                        status.outcome == Outcome::limits || status.outcome == Outcome::penetration;
  const bool asked = control.torque.value.size() > 0 && !control.torque.value.isZero(0) &&
                     control.torque.rate.isZero(0);
  return blown_up && asked
             ? "; stiff or damping torques of a control law must be implicit: give damping as "
               "torque_rate, and a pull to angles as rest_shape"
             : "";
}

void check_control(const Model& model, const Control& control) {
  check_torque(model, "rest_shape", control.rest_shape);
  check_torque(model, "torque", control.torque.value);
  check_torque(model, "torque's rate", control.torque.rate);
  if (control.torque.rate.size() != control.torque.value.size()) {
    throw std::invalid_argument("control: torque and torque's rate differ in length");
  }
  if ((control.torque.rate.array() < 0).any() || !(control.tip.rate >= 0)) {
    throw std::invalid_argument("control: a damping rate is negative; it must be 0 or more");
  }
  if (!control.tip.value.allFinite() || !std::isfinite(control.tip.rate)) {
    throw std::invalid_argument("control: the tip force is not finite");
  }
  if (control.tip.body < -1 || control.tip.body >= model.body_count()) {
    throw std::invalid_argument("control: the tip force is on a body that does not exist");
  }
  const std::vector<ThigmotaxisCommand>& commands = control.thigmotaxis;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    check_command(model, commands[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (commands[i].end == commands[j].end &&
          (commands[i].end != KnotEnd::neither ||
           same_segments(commands[i].contact, commands[j].contact))) {
        throw std::invalid_argument(
            fmt::format("control: two commands of Eq. 6 are {}",
                        commands[i].end == KnotEnd::neither
                            ? fmt::format("at bodies {} and {}", commands[i].contact.body_a(),
                                          commands[i].contact.body_b())
                            : "at one end of the knot"));
      }
    }
  }
}

}  // namespace hagfish
