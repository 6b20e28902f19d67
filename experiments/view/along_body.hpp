// What is shown along the body at a moment, whether that is a frame of a log or a run as it goes:
// numbers at joints and bodies.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/chain/bending.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

/// The kinds of joints, by their hinges.
enum class Turn { bend = 2, twist = 1 };

inline double body_length(const Model& model) { return model.length() / model.body_count(); }

/// `value(body, its first velocity)` of each joint of a kind, from the head.
template <class Value>
std::vector<double> of_joints(const Model& model, Turn turn, const Value& value) {
  std::vector<double> values;
  for (int b = 1; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    if (body.dofs == static_cast<int>(turn)) values.push_back(value(b, body.first_dof));
  }
  return values;
}

/// Places of these joints, cm of arc.
inline std::vector<double> joint_arcs(const Model& model, Turn turn) {
  return of_joints(model, turn, [&](int body, int /*first*/) { return body * body_length(model); });
}

/// Size of the moments (3 x N, in axes_of_joints) about the axes that these joints turn about; 0
/// where there is no mean yet.
inline std::vector<double> moments_along(const Model& model, Turn turn,
                                         const Eigen::Ref<const Eigen::Matrix3Xd>& moments) {
  return of_joints(model, turn, [&](int body, int /*first*/) {
    const Eigen::Vector3d moment = moments.col(body);
    const double size = turn == Turn::bend ? moment.tail<2>().norm() : std::abs(moment.x());
    return std::isfinite(size) ? size : 0;
  });
}

/// A joint's turn over the length of body that it stands for, rad/cm, not negative.
inline std::vector<double> shape_along(const Model& model, Turn turn, const Eigen::VectorXd& q) {
  return of_joints(model, turn, [&](int body, int first) {
    const double angle =
        turn == Turn::twist ? std::abs(q[first + 1]) : total_bend(q[first + 1], q[first + 2]).angle;
    return angle / hinge_span(model, body);
  });
}

/// Centres of the bodies, cm of arc.
inline std::vector<double> body_centres(const Model& model) {
  std::vector<double> arcs;
  for (int b = 0; b < model.body_count(); ++b) arcs.push_back((b + 0.5) * body_length(model));
  return arcs;
}

/// Adds a contact's force (dyn), which bears at an arc length (cm), to the force per length at the
/// bodies (dyn/cm): to be seen, it is spread over half a centimetre of body.
inline void spread_contact(const Model& model, double force, double arc,
                           std::vector<double>& along) {
  constexpr double spread = 0.5;  // standard deviation, cm
  constexpr double reach = 5;     // so many of them away nothing is left
  for (std::size_t k = 0; k < along.size(); ++k) {
    const double away = ((static_cast<double>(k) + 0.5) * body_length(model) - arc) / spread;
    if (std::abs(away) > reach) continue;
    along[k] += force * std::exp(-0.5 * away * away) / (spread * std::sqrt(2 * std::numbers::pi));
  }
}

}  // namespace hagfish
