#include "core/chain/skin_fold.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/chain/bending.hpp"
#include "core/scene/interpolation.hpp"

namespace hagfish {
namespace {

/// The direction of the body, not of unit length, from half way before its first bending joint to
/// half way behind its last one.
struct Heading {
  std::vector<double> arc;            ///< cm from the head
  std::vector<Eigen::Vector3d> axis;  ///< X of the bodies there, world

  Heading(const Model& model, const Kinematics& kin) {
    double from = 0, to = 0;
    for (int b = 0; b < model.body_count(); ++b) {
      to += model.bodies[b].length;
      if (b + 1 < model.body_count() && !bends(model.bodies[b + 1])) continue;
      arc.push_back(0.5 * (from + to));
      axis.emplace_back(kin.rotation[b].col(0));
      from = to;
    }
  }
  Eigen::Vector3d operator()(double at) const {
    const Bracket place = bracket_of(arc, at);
    Eigen::Vector3d found;
    for (int i = 0; i < 3; ++i)
      found[i] = value_at(place, [&](std::size_t k) { return axis[k][i]; });
    return found;
  }
};

}  // namespace

double skin_fold(const Model& model, const Kinematics& kin) {
  const Heading heading(model, kin);
  double most = 0, middle = 0;
  for (const Body& body : model.bodies) {
    middle += 0.5 * body.length;
    const double from = middle - body.radius, to = middle + body.radius;
    middle += 0.5 * body.length;
    if (from < heading.arc.front() || to > heading.arc.back()) continue;
    const Eigen::Vector3d a = heading(from), b = heading(to);
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    most = std::max(most, 0.5 * turn);  // turn / d times r
  }
  return most;
}

}  // namespace hagfish
