#include "core/run/active_curvature.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Where `x` lies among rising `knots`: the one at or before it, and the share of the way to the
/// next.
struct Place {
  std::size_t index = 0;
  double share = 0;
};

Place place_among(const std::vector<double>& knots, double x) {
  if (x <= knots.front() || knots.size() == 1) return {0, 0};
  if (x >= knots.back()) return {knots.size() - 2, 1};
  const auto next = std::ranges::upper_bound(knots, x);
  const auto k = static_cast<std::size_t>(next - knots.begin()) - 1;
  return {k, (x - knots[k]) / (knots[k + 1] - knots[k])};
}

/// One of the program's values at a place among its times, rad per body length. Fused here and
/// below as written, not as a compiler likes, so that runs repeat.
double value_at(const CurvatureProgram& program, const Place& when, int row, Eigen::Index station) {
  const auto at = [&](std::size_t k) {
    const double value = program.value[k](row, station);
    return program.noise.empty() ? value : value + program.noise[k](row, station);
  };
  if (when.share == 0) return at(when.index);
  return std::fma(when.share, at(when.index + 1), (1 - when.share) * at(when.index));
}

/// Length of body that a hinge stands for, cm.
double span_of(const Model& model, const Hinge& hinge) {
  return hinge_span(model.body_count(), model.bodies[hinge.body].length, hinge.body);
}

/// The program's shape into `shape` (nv).
void set_program_shape(const Model& model, const CurvatureProgram& program, double time,
                       Eigen::VectorXd& shape) {
  const Place when = place_among(program.time, time);
  const double length = model.length();
  shape.setZero(model.nv());
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    const Hinge& hinge = model.hinges[k];
    const Place place =
        place_among(program.station, static_cast<double>(hinge.body) / model.body_count());
    // Columns are about Y, about Z, twist.
    const int row = (static_cast<int>(hinge.axis) + 2) % 3;
    const auto j = static_cast<Eigen::Index>(place.index);
    double value = value_at(program, when, row, j);
    if (place.share > 0) {
      value = std::fma(place.share, value_at(program, when, row, j + 1) - value, value);
    }
    shape[root_dofs + static_cast<Eigen::Index>(k)] = span_of(model, hinge) / length * value;
  }
}

}  // namespace

Eigen::VectorXd program_shape(const Model& model, const CurvatureProgram& program, double time) {
  Eigen::VectorXd shape;
  set_program_shape(model, program, time, shape);
  return shape;
}

void move_rest_shape(const Model& model, const Scene& scene, Phase phase, const Eigen::VectorXd& q,
                     double time, Eigen::VectorXd& rest) {
  const double h = scene.time.step;
  const auto count = static_cast<Eigen::Index>(model.hinges.size());
  const auto angles = q.tail(count);
  if (phase == Phase::form) {
    set_program_shape(model, scene.script.curvature, time + scene.time.reach(), rest);
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

void active_torque(const Model& model, const Scene& scene, const State& state,
                   const Eigen::VectorXd& rest, ActiveTorque& torque) {
  const double h = scene.time.reach();
  const double capacity = scene.active.capacity;
  torque.value.setZero(model.nv());
  torque.rate.setZero(model.nv());
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double stiffness = scene.active.stiffness / span_of(model, hinge);
    const double value = stiffness * (rest[k] - state.q[k + 1]) + hinge.stiffness * rest[k];
    const double expected = value - h * stiffness * state.qdot[k];
    if (std::abs(expected) <= capacity) {
      torque.value[k] = value;
      torque.rate[k] = h * stiffness;
    } else {
      torque.value[k] = std::copysign(capacity, expected);
    }
  }
}

ActiveTorque active_torque(const Model& model, const Scene& scene, const State& state,
                           const Eigen::VectorXd& rest) {
  ActiveTorque torque;
  active_torque(model, scene, state, rest, torque);
  return torque;
}

}  // namespace hagfish
