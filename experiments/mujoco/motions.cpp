#include "experiments/mujoco/motions.hpp"

#include <cmath>
#include <numbers>

namespace hagfish {
namespace {

constexpr std::array<double, 3> axis_share = {0.2, 1, 0.5};  // of X, Y, Z

Motion::Bend coil(double /*station*/, double arc) {
  constexpr double curvature = 0.12;  // rad/cm
  constexpr double uncoiling = 1;     // share of the angle that opens in a second, 1/s
  return {curvature * arc, -uncoiling * curvature * arc};
}

Motion::Bend hanging(double station, double arc) {
  constexpr double curvature = 0.05;  // at the bow's middle, rad/cm
  return {curvature * arc * std::sin(std::numbers::pi * station), 0};
}

Motion::Bend whip(double station, double arc) {
  constexpr double reach = 0.2;  // share of the body that turns
  constexpr double rate = 1;     // of its curvature, rad/(cm s)
  return {0, station < reach ? rate * arc : 0};
}

constexpr double standard_gravity = 981;  // cm/s^2

}  // namespace

const std::array<Motion, 3> motions{{{"coil", "released coil", 0, coil},
                                     {"hanging", "hanging chain", standard_gravity, hanging},
                                     {"whip", "whip", 0, whip}}};

State start_of(const Motion& motion, const Model& model) {
  State state = rest_state(model);
  // Each hinge stands for two bodies' length.
  const double arc = 2 * model.length() / model.body_count();
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    const Hinge& hinge = model.hinges[k];
    const Motion::Bend bend =
        motion.bend(static_cast<double>(hinge.body) / model.body_count(), arc);
    const double share = axis_share[static_cast<std::size_t>(hinge.axis)];
    const auto i = static_cast<Eigen::Index>(k) + root_dofs;
    state.q[i + 1] = share * bend.angle;
    state.qdot[i] = share * bend.rate;
  }
  return state;
}

}  // namespace hagfish
