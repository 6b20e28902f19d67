#include "core/muscle/active_curvature.hpp"

#include <cmath>

#include "core/scene/interpolation.hpp"

namespace hagfish {
namespace {

/// One of the program's values at one station, interpolated in time, rad per body length.
double program_value(const CurvatureProgram& program, const Bracket& when, int row,
                     std::size_t station) {
  return value_at(when, [&](std::size_t k) {
    const auto j = static_cast<Eigen::Index>(station);
    const double value = program.value[k](row, j);
    return program.noise.empty() ? value : value + program.noise[k](row, j);
  });
}

}  // namespace

void program_shape(const Model& model, const CurvatureProgram& program, double time,
                   Eigen::VectorXd& shape) {
  const Bracket when = bracket_of(program.time, time);
  const double length = model.length();
  shape.setZero(model.nv());
  for (int k = 0; k < model.hinge_count(); ++k) {
    const Hinge& hinge = model.hinges[k];
    const Bracket place =
        bracket_of(program.station, static_cast<double>(hinge.body) / model.body_count());
    const int row = shape_row(hinge.axis);
    const double value =
        value_at(place, [&](std::size_t j) { return program_value(program, when, row, j); });
    shape[root_dofs + k] = hinge_span(model, hinge.body) / length * value;
  }
}

Eigen::VectorXd program_shape(const Model& model, const CurvatureProgram& program, double time) {
  Eigen::VectorXd shape;
  program_shape(model, program, time, shape);
  return shape;
}

void move_rest_shape(const Model& model, const Scene& scene, Phase phase, const Eigen::VectorXd& q,
                     double time, Eigen::VectorXd& rest) {
  const double h = scene.time.step;
  const Eigen::Index count = model.hinge_count();
  const auto angles = q.tail(count);
  if (phase == Phase::form) {
    program_shape(model, scene.script.curvature, time + scene.time.reach(), rest);
    return;
  }
  if (rest.size() == 0) {
    rest = Eigen::VectorXd::Zero(model.nv());
    rest.tail(count) = angles;
  }
  if (phase == Phase::release || phase == Phase::free) {
    rest *= std::exp(-h / scene.active.relax_time);
  } else {
    const double kept = std::exp(-h / scene.active.tone_time);
    rest.tail(count) = angles + kept * (rest.tail(count) - angles);
  }
}

void active_torque(const Model& model, const ActiveSettings& active, const State& state,
                   const Eigen::VectorXd& rest, double ahead, ActiveTorque& torque) {
  const double capacity = active.capacity;
  torque.value.setZero(model.nv());
  torque.rate.setZero(model.nv());
  torque.saturated = -1;
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double stiffness = active.stiffness / hinge_span(model, hinge.body);
    const double value = stiffness * (rest[k] - state.q[k + 1]) + hinge.stiffness * rest[k];
    const double expected = value - ahead * stiffness * state.qdot[k];
    if (std::abs(expected) <= capacity) {
      torque.value[k] = value;
      torque.rate[k] = ahead * stiffness;
    } else {
      torque.value[k] = std::copysign(capacity, expected);
      if (torque.saturated < 0) torque.saturated = k;
    }
  }
}

void bound_torque(double capacity, const Eigen::VectorXd& qdot, const ActiveTorque& active,
                  ActiveTorque& torque) {
  torque.saturated = -1;
  for (Eigen::Index k = root_dofs; k < torque.value.size(); ++k) {
    const double towards =
        active.value.size() == 0 ? 0 : active.value[k] - active.rate[k] * qdot[k];
    const double expected = towards + torque.value[k] - torque.rate[k] * qdot[k];
    if (std::abs(expected) <= capacity) continue;
    torque.value[k] = std::copysign(capacity, expected) - towards;
    torque.rate[k] = 0;
    if (torque.saturated < 0) torque.saturated = static_cast<int>(k);
  }
}

ActiveTorque active_torque(const Model& model, const Scene& scene, const State& state,
                           const Eigen::VectorXd& rest) {
  ActiveTorque torque;
  active_torque(model, scene.active, state, rest, scene.time.reach(), torque);
  return torque;
}

}  // namespace hagfish
