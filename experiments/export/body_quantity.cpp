#include "experiments/export/body_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>

#include "core/chain/bending.hpp"
#include "core/contact/spline.hpp"
#include "core/muscle/paths.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {
namespace {

/// Standard deviation of the body length over which a contact's force is spread, cm; nothing is
/// left of it this many of them away.
constexpr double spread = 0.5;
constexpr double reach = 5;
constexpr double large_share = 0.99;

enum class Turn { bend, twist };

/// Bodies whose joint bends (two hinges) or twists (one).
std::vector<int> joints_of(const Model& model, Turn turn) {
  std::vector<int> joints;
  for (int b = 1; b < model.body_count(); ++b) {
    if (model.bodies[b].dofs == (turn == Turn::bend ? 2 : 1)) joints.push_back(b);
  }
  return joints;
}

double body_length(const Model& model) { return model.length() / model.body_count(); }

/// Fills a quantity that each joint of a kind has by itself.
void fill(const LogContents& log, Turn turn, BodyQuantity& quantity,
          const std::function<double(Eigen::Index frame, const Body& joint, double span)>& value) {
  const std::vector<int> joints = joints_of(log.model, turn);
  quantity.values.resize(log.q.rows(), static_cast<Eigen::Index>(joints.size()));
  const double length = body_length(log.model);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    quantity.arc.push_back(joints[j] * length);
    const double span = hinge_span(log.model, joints[j]);
    for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
      quantity.values(f, static_cast<Eigen::Index>(j)) =
          value(f, log.model.bodies[joints[j]], span);
    }
  }
}

void fill_torque(const LogContents& log, const std::string& dataset, Turn turn,
                 BodyQuantity& quantity) {
  const Hdf5Reader::Rows rows = log.h5.rows(dataset);
  fill(log, turn, quantity, [&rows](Eigen::Index f, const Body& joint, double /*span*/) {
    const double size = rows.row(f).segment(joint.first_dof, joint.dofs).norm();
    return std::isfinite(size) ? size : 0;  // of the first frame there is no mean
  });
}

void fill_activation(const LogContents& log, BodyQuantity& quantity) {
  const Hdf5Reader::Rows rows = log.h5.rows("/muscle/activation");
  std::map<int, MuscleGroup> groups;  // by the first velocity of their joint
  for (MuscleGroup g = muscle_group(log.model, 0); g.count > 0;
       g = muscle_group(log.model, g.first + g.count)) {
    groups[log.model.bodies[log.model.muscles[g.first].body].first_dof] = g;
  }
  fill(log, Turn::bend, quantity, [&](Eigen::Index f, const Body& joint, double /*span*/) {
    const MuscleGroup& group = groups.at(joint.first_dof);
    const double most = rows.row(f).segment(group.first, group.count).maxCoeff();
    return std::isfinite(most) ? most : 0;  // of the first frame there is no mean
  });
}

void fill_shape(const LogContents& log, Turn turn, BodyQuantity& quantity) {
  fill(log, turn, quantity, [&](Eigen::Index f, const Body& joint, double span) {
    const double first = log.q(f, joint.first_dof + 1);
    return (turn == Turn::twist ? std::abs(first)
                                : total_bend(first, log.q(f, joint.first_dof + 2)).angle) /
           span;
  });
}

void fill_contact(const LogContents& log, BodyQuantity& quantity) {
  const std::vector<std::int64_t> frame = log.h5.integers("/contacts/frame");
  const std::vector<double> a = log.h5.doubles("/contacts/spline_a");
  const std::vector<double> b = log.h5.doubles("/contacts/spline_b");
  const std::vector<double> force = log.h5.doubles("/contacts/force");
  const double length = body_length(log.model);
  const int n = log.model.body_count();
  for (int k = 0; k < n; ++k) quantity.arc.push_back((k + 0.5) * length);
  quantity.values.setZero(log.q.rows(), n);
  for (std::size_t c = 0; c < frame.size(); ++c) {
    for (const double parameter : {a[c], b[c]}) {
      if (!on_spline(log.model, parameter) || !(force[c] > 0)) continue;
      const double arc = (parameter + 0.5) * length;
      for (int k = 0; k < n; ++k) {
        const double away = (quantity.arc[k] - arc) / spread;
        if (std::abs(away) > reach) continue;
        quantity.values(frame[c], k) +=
            force[c] * std::exp(-0.5 * away * away) / (spread * std::sqrt(2 * std::numbers::pi));
      }
    }
  }
}

}  // namespace

std::vector<std::string> body_quantity_names() {
  return {"thigmotaxis", "thigmotaxis-twist", "active", "activation", "curvature", "twist",
          "contact"};
}

bool has_quantity(const LogContents& log, const std::string& name) {
  return name != "activation" || !log.model.muscles.empty();
}

BodyQuantity body_quantity(const LogContents& log, const std::string& name) {
  const auto made = [&name](const char* label, const char* unit) {
    return BodyQuantity{name, label, unit, {}, {}};
  };
  BodyQuantity quantity;
  if (name == "thigmotaxis" || name == "thigmotaxis-twist") {
    const Turn turn = name == "thigmotaxis" ? Turn::bend : Turn::twist;
    quantity = made(turn == Turn::bend ? "f_thigmo, bending" : "f_thigmo, twisting", "dyn cm");
    fill_torque(log, "/mean/forces/thigmotaxis", turn, quantity);
  } else if (name == "active") {
    quantity = made("active torque, bending", "dyn cm");
    fill_torque(log, "/mean/forces/active", Turn::bend, quantity);
  } else if (name == "activation") {
    quantity = made("largest activation of a bending joint", "1");
    fill_activation(log, quantity);
  } else if (name == "curvature" || name == "twist") {
    const Turn turn = name == "curvature" ? Turn::bend : Turn::twist;
    quantity = made(name.c_str(), "rad/cm");
    fill_shape(log, turn, quantity);
  } else if (name == "contact") {
    quantity = made("contact force per length", "dyn/cm");
    fill_contact(log, quantity);
  } else {
    throw std::invalid_argument("no quantity of the body is called " + name);
  }
  return quantity;
}

double colour_scale(const BodyQuantity& quantity) {
  std::vector<double> some;
  for (const double value : quantity.values.reshaped()) {
    if (value > 0) some.push_back(value);
  }
  if (some.empty()) return 0;
  const auto place = some.begin() + static_cast<std::ptrdiff_t>(
                                        large_share * static_cast<double>(some.size() - 1));
  std::ranges::nth_element(some, place);
  return *place;
}

}  // namespace hagfish
