#include "core/control/control_law.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace hagfish {
namespace {

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
  constexpr double rounding = 1e-9;  // error of a unit vector
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

}  // namespace

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
           commands[i].contact.same_segments(commands[j].contact))) {
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
