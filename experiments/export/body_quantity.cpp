#include "experiments/export/body_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/contact/spline.hpp"
#include "core/muscle/paths.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "experiments/view/along_body.hpp"

namespace hagfish {
namespace {

constexpr double large_share = 0.99;

/// Fills a quantity that each joint of a kind has by itself: `of_frame` gives those of a frame.
template <class OfFrame>
void fill(const LogContents& log, Turn turn, BodyQuantity& quantity, const OfFrame& of_frame) {
  quantity.arc = joint_arcs(log.model, turn);
  quantity.values.resize(log.q.rows(), std::ssize(quantity.arc));
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const std::vector<double> values = of_frame(f);
    quantity.values.row(f) = Eigen::VectorXd::Map(values.data(), std::ssize(values));
  }
}

/// Earlier logs have torques of hinges alone.
void fill_moment(const LogContents& log, const std::string& kind, Turn turn,
                 BodyQuantity& quantity) {
  const int n = log.model.body_count();
  const bool known = log.h5.has("/mean/moments/" + kind);
  const Hdf5Reader::Rows rows = log.h5.rows((known ? "/mean/moments/" : "/mean/forces/") + kind);
  if (!known) quantity.label += " (torques of hinges)";
  fill(log, turn, quantity, [&](Eigen::Index f) {
    Eigen::Matrix3Xd moments = Eigen::Matrix3Xd::Zero(3, n);
    if (known) {
      moments = Eigen::Map<const Eigen::Matrix3Xd>(rows.row(f).data(), 3, n);
    } else {
      for (Eigen::Index k = root_dofs; k < rows.cols(); ++k) {
        const Hinge& hinge = log.model.hinges[k - root_dofs];
        moments(static_cast<int>(hinge.axis), hinge.body) = rows(f, k);
      }
    }
    return moments_along(log.model, turn, moments);
  });
}

void fill_activation(const LogContents& log, BodyQuantity& quantity) {
  const Hdf5Reader::Rows rows = log.h5.rows("/muscle/activation");
  std::map<int, MuscleGroup> groups;  // by the first velocity of their joint
  for (MuscleGroup g = muscle_group(log.model, 0); g.count > 0;
       g = muscle_group(log.model, g.first + g.count)) {
    groups[log.model.bodies[log.model.muscles[g.first].body].first_dof] = g;
  }
  fill(log, Turn::bend, quantity, [&](Eigen::Index f) {
    return of_joints(log.model, Turn::bend, [&](int /*body*/, int first) {
      const MuscleGroup& group = groups.at(first);
      const double most = rows.row(f).segment(group.first, group.count).maxCoeff();
      return std::isfinite(most) ? most : 0;  // of the first frame there is no mean
    });
  });
}

void fill_contact(const LogContents& log, BodyQuantity& quantity) {
  quantity.arc = body_centres(log.model);
  std::vector<std::vector<double>> along(log.time.size(),
                                         std::vector<double>(quantity.arc.size(), 0.0));
  for (const LoggedContact& c : logged_contacts(log)) {
    for (const double parameter : {c.a, c.b}) {
      if (!on_spline(log.model, parameter) || !(c.force > 0)) continue;
      spread_contact(log.model, c.force, (parameter + 0.5) * body_length(log.model),
                     along[static_cast<std::size_t>(c.frame)]);
    }
  }
  quantity.values.resize(log.q.rows(), std::ssize(quantity.arc));
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    quantity.values.row(f) =
        Eigen::VectorXd::Map(along[static_cast<std::size_t>(f)].data(), std::ssize(quantity.arc));
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
    fill_moment(log, "thigmotaxis", turn, quantity);
  } else if (name == "active") {
    quantity = made("muscles' moment, bending", "dyn cm");
    fill_moment(log, "active", Turn::bend, quantity);
  } else if (name == "activation") {
    quantity = made("largest activation of a bending joint", "1");
    fill_activation(log, quantity);
  } else if (name == "curvature" || name == "twist") {
    const Turn turn = name == "curvature" ? Turn::bend : Turn::twist;
    quantity = made(name.c_str(), "rad/cm");
    fill(log, turn, quantity,
         [&](Eigen::Index f) { return shape_along(log.model, turn, log.q.row(f)); });
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
