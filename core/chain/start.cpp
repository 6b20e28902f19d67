#include "core/chain/start.hpp"

#include <algorithm>
#include <array>
#include <random>

#include "core/chain/bending.hpp"

namespace hagfish {
namespace {

/// What each hinge takes of a bend (rows as in StartSettings), rad or rad/s.
Eigen::VectorXd hinge_shares(const Model& model, const std::vector<Eigen::Vector4d>& bend) {
  const int count = model.hinge_count();
  Eigen::VectorXd share = Eigen::VectorXd::Zero(count);
  if (bend.empty()) return share;
  std::vector<double> station;
  std::array<std::vector<double>, 3> about;
  for (const Eigen::Vector4d& row : bend) {
    station.push_back(row[0]);
    for (int axis = 0; axis < 3; ++axis) about[axis].push_back(row[1 + axis]);
  }
  const int n = model.body_count();
  for (int k = 0; k < count; ++k) {
    const Hinge& hinge = model.hinges[k];
    share[k] = hinge_span(model, hinge.body) * profile(station, about[static_cast<int>(hinge.axis)],
                                                       static_cast<double>(hinge.body) / n);
  }
  return share;
}

void stop_at_limits(const Model& model, State& state) {
  for (int k = 0; k < model.hinge_count(); ++k) {
    double& angle = state.q[root_dofs + 1 + k];
    angle = std::clamp(angle, model.hinges[k].lower, model.hinges[k].upper);
  }
  for (const BendingCone& cone : model.cones) {
    auto angles = state.q.segment<2>(cone.dof + 1);
    if (past_cone(cone, state.q) > 0) angles = bend_to(angles[0], angles[1], cone.limit);
  }
}

}  // namespace

State start_state(const Model& model, const StartSettings& settings) {
  State state = rest_state(model);
  const int count = model.hinge_count();
  if (!settings.q.empty()) {
    state.q = Eigen::VectorXd::Map(settings.q.data(), model.nq());
    state.q.segment<4>(3).normalize();
  } else {
    state.q.tail(count) = hinge_shares(model, settings.bend);
    stop_at_limits(model, state);
  }
  if (!settings.qdot.empty()) {
    state.qdot = Eigen::VectorXd::Map(settings.qdot.data(), model.nv());
  } else {
    state.qdot.segment<3>(3) = settings.spin;
    state.qdot.tail(count) = hinge_shares(model, settings.bend_rate);
  }
  if (settings.noise > 0) {
    std::mt19937 random(settings.seed);
    std::normal_distribution<double> normal(0, settings.noise);
    for (int k = 0; k < count; ++k) state.q[root_dofs + 1 + k] += normal(random);
    stop_at_limits(model, state);
  }
  return state;
}

}  // namespace hagfish
