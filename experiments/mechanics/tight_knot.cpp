#include "experiments/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/loose_knot.hpp"
#include "experiments/mechanics/rod.hpp"

namespace hagfish {
namespace {

using Curve = std::vector<Eigen::Vector3d>;

constexpr double radius = 0.5;  // cm: lengths are in diameters
constexpr double pull = 1;      // dyn
constexpr double coarse = 0.5;  // cm, a body at first
constexpr int most_steps = 6000;
// A smooth curve through long bodies comes nearer to itself than they do, by up to 7 % of the
// diameter. A rope that starts with such overlaps all along may have no step that undoes them.
constexpr double loosened = 1.1;

/// Shastri's figure eight (t³ - 3t, t (t² - 1) (t² - 4), t⁷ - 42t), run on straight at both ends.
Curve figure_eight() {
  const auto at = [](double t) -> Eigen::Vector3d {
    const double tt = t * t;
    return {2.5 * t * (tt - 3), 1.6 * t * (tt - 1) * (tt - 4), 0.09 * t * (tt * tt * tt - 42)};
  };
  constexpr double end = 2.15;
  constexpr double by = 1e-4;
  const Eigen::Vector3d way =
      (at(end) - at(end - by)).normalized();  // odd: the same at the other end
  Curve curve;
  for (double s = 5; s > 0; s -= 0.01) curve.push_back(at(-end) - s * way);
  for (double t = -end; t < end; t += by) curve.push_back(at(t));
  for (double s = 0; s < 5; s += 0.01) curve.push_back(at(end) + s * way);
  return curve;
}

/// The Lissajous knot 5_2, opened where it is furthest out: both tails turn back there and run on
/// side by side of it.
Curve lissajous() {
  constexpr double scale = 5.5;
  const auto at = [&](double t) -> Eigen::Vector3d {
    return scale * Eigen::Vector3d(std::cos(3 * t + 0.7), std::cos(2 * t + 0.2), std::cos(7 * t));
  };
  constexpr double by = 1e-4;
  constexpr double round = 2 * std::numbers::pi;
  double out = 0;
  for (double t = 0; t < round; t += by) {
    if (at(t).norm() > at(out).norm()) out = t;
  }
  const Eigen::Vector3d top = at(out);
  const Eigen::Vector3d up = top.normalized();
  const Eigen::Vector3d along = (at(out + by) - at(out - by)).normalized();
  const double speed = (at(out + by) - at(out - by)).norm() / (2 * by);
  Curve points;
  for (int k = 10; k >= 0; --k) points.emplace_back(top + 2 * up + k * along);
  points.emplace_back(top + up - along);
  const double last = out + round - 3.5 / speed;
  double before = out;
  for (double t = out + 1 / speed; t < last; t += by) {
    if (before == out || (at(t) - at(before)).norm() > 0.7) {
      points.push_back(at(t));
      before = t;
    }
  }
  points.emplace_back(top + up - 2.5 * along);
  for (int k = 3; k < 12; ++k) points.emplace_back(top + 2 * up - (k + 0.5) * along);
  Eigen::Matrix3Xd centre(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    centre.col(static_cast<Eigen::Index>(i)) = points[i];
  return smooth_through(centre, 0, static_cast<int>(points.size()));
}

Curve start_of(const std::string& type) {
  if (type == "4_1") return figure_eight();
  if (type == "5_2") return lissajous();
  if (type != "3_1" && type != "5_1") {
    throw std::invalid_argument("no start for a knot " + type);
  }
  const double thin = type == "3_1" ? 0.08 : 0.04;
  Curve curve = loose_curve({.crossings = type[0] - '0', .radius = thin}, 5 * thin);
  for (Eigen::Vector3d& point : curve) point *= radius / thin;
  return curve;
}

Pulled rope_along(const Curve& curve, double link) {
  // Damping does not move where the rope comes to rest: it lets steps be long.
  const Rod rope{.radius = radius, .bending_damping = 1, .sharpest = 1 / radius};
  const double apart =
      std::numbers::pi * radius + link;  // half of the sharpest circle does not touch itself
  return {chain_of(rope, link, links_along(curve, link)), pulled_scene(radius, pull, 1e-3, apart)};
}

}  // namespace

TightKnot tighten(const std::string& type, double link) {
  const double begin = cpu_time();
  Pulled rope = rope_along(start_of(type), coarse);
  rope.relax(1e-3, most_steps);
  // Again with shorter bodies and without most of the tails.
  double head = rope.model().body_count();
  double tail = 0;
  for (const ContactForce& contact : rope.contact_forces()) {
    head = std::min(head, contact.head);
    tail = std::max(tail, contact.tail);
  }
  const double kept = 2 / coarse;  // two diameters of each tail
  Curve curve = smooth_through(rope.kin().centre, static_cast<int>(head - kept),
                               static_cast<int>(tail + kept));
  for (Eigen::Vector3d& point : curve) point *= loosened;
  rope = rope_along(curve, link);
  TightKnot knot;
  knot.at_rest = rope.relax(2e-5, most_steps);
  knot.type = rope.knot();
  knot.bodies = rope.model().body_count();
  const Eigen::Matrix3Xd& centre = rope.kin().centre;
  knot.shortening = link * (knot.bodies - 1) - (centre.rightCols<1>() - centre.col(0)).norm();
  knot.cpu = cpu_time() - begin;
  return knot;
}

}  // namespace hagfish
