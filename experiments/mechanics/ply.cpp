#include "experiments/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/rod.hpp"

namespace hagfish {
namespace {

constexpr double pull = 0.5;  // dyn: with B = 1 dyn cm^2 the tails' bends fade over 1.4 cm
constexpr double tail = 6;    // cm, each
constexpr double turns = 2.5;

/// F R² / B and M R / B of a ply whose strands touch without friction.
double force_at(double angle) {
  return std::pow(std::sin(angle), 3) *
         (std::cos(angle) * std::tan(2 * angle) - 0.5 * std::sin(angle));
}
double moment_at(double angle) { return std::tan(2 * angle) * std::pow(std::sin(angle), 2); }

/// Tails along X, a ply along Y of this angle, whose strands are `radius` from its axis, and a
/// round end.
std::vector<Eigen::Vector3d> start_curve(double angle, double radius) {
  const double pitch = 2 * std::numbers::pi * radius / std::tan(angle);
  const double base = 1.5;
  const double top = base + turns * pitch;
  std::vector<Eigen::Vector3d> points;
  const auto across = [&](double y) {
    const double turned = std::numbers::pi + 2 * std::numbers::pi * (y - base) / pitch;
    return Eigen::Vector3d(std::cos(turned), 0, std::sin(turned));
  };
  const auto strand = [&](double y, double side) -> Eigen::Vector3d {
    return y * Eigen::Vector3d::UnitY() + side * radius * across(y);
  };
  for (double x = tail + 1; x > 1; x -= 0.5) points.emplace_back(-x, 0, 0);
  points.emplace_back(-0.7, 0.25, 0);
  points.emplace_back(-1.2 * radius, 0.8, 0);
  constexpr double fine = 0.15;
  for (double y = base; y < top; y += fine) points.push_back(strand(y, 1));
  const Eigen::Vector3d side = across(top);
  for (const auto& [y, out] : {std::pair{0.5, 0.7},
                               {1.2, 1.0},
                               {1.9, 0.6},
                               {2.15, 0.0},
                               {1.9, -0.6},
                               {1.2, -1.0},
                               {0.5, -0.7}}) {
    points.emplace_back((top + y) * Eigen::Vector3d::UnitY() + out * side);
  }
  for (double y = top; y > base; y -= fine) points.push_back(strand(y, -1));
  points.emplace_back(1.2 * radius, 0.8, 0);
  points.emplace_back(0.7, 0.25, 0);
  for (double x = 1; x < tail + 1; x += 0.5) points.emplace_back(x, 0, 0);
  Eigen::Matrix3Xd all(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = points[i];
  return smooth_through(all, 0, static_cast<int>(points.size()));
}

/// The angle of the strands and half of their distance, cm, from where they touch in the middle
/// half of the ply.
std::pair<double, double> shape_of(const Pulled& rod) {
  std::vector<ContactForce> touches = rod.contact_forces();
  std::ranges::sort(touches, {}, &ContactForce::head);
  const double from = 0.75 * touches.front().head + 0.25 * touches.back().head;
  const double to = 0.25 * touches.front().head + 0.75 * touches.back().head;
  std::erase_if(touches,
                [&](const ContactForce& touch) { return touch.head < from || touch.head > to; });
  if (touches.size() < 8) throw std::runtime_error("the strands of a ply do not touch");
  const std::vector<Eigen::Vector3d> curve =
      smooth_through(rod.kin().centre, 1, rod.model().body_count());
  const auto at = [&](double place) {
    return curve[static_cast<std::size_t>(std::lround(50 * (place - 1)))];
  };
  std::vector<Eigen::Vector3d> middle;
  std::vector<Eigen::Vector3d> apart;
  double radius = 0;
  for (const ContactForce& touch : touches) {
    middle.emplace_back(0.5 * (at(touch.head) + at(touch.tail)));
    apart.emplace_back(at(touch.tail) - at(touch.head));
    radius += 0.5 * apart.back().norm() / static_cast<double>(touches.size());
  }
  const Eigen::Vector3d axis = middle.back() - middle.front();
  double turned = 0;
  for (std::size_t i = 1; i < apart.size(); ++i) {
    turned +=
        std::atan2(apart[i - 1].cross(apart[i]).dot(axis.normalized()), apart[i].dot(apart[i - 1]));
  }
  return {std::atan2(radius * std::abs(turned), axis.norm()), radius};
}

}  // namespace

Ply wind_up(const PlyInput& input) {
  const double begin = cpu_time();
  const double radius = std::sqrt(force_at(input.angle) / pull);
  const double link = radius / input.per_radius;
  const double moment = moment_at(input.angle) / radius;
  const Rod material{.radius = radius, .bending = 1, .bending_damping = 1, .twisting = 1};
  RodChain chain =
      chain_of(material, link, links_along(start_curve(input.angle, 1.03 * radius), link),
               2 * link * moment);
  const int last = chain.model.body_count() - 1;
  // The longer the ply, the less it is twisted: so it comes to rest at one length.
  constexpr double spring = 0.02;  // dyn
  constexpr double hold = 0.5;     // dyn/cm
  const double start = kinematics(chain.model, chain.state).centre(0, last);
  const auto twist = [=](const Kinematics& kin) {
    const double now = moment + spring * (kin.centre(0, last) - start);
    // The tail stays on its line: under a moment that does not follow it, it would swing.
    const Eigen::Vector3d off = kin.centre.col(last);
    return std::vector<Load>{
        {last, {0, -hold * off.y(), -hold * off.z()}, now * Eigen::Vector3d::UnitX()}};
  };
  constexpr double apart = 3;  // cm: the round end does not touch itself
  Pulled rod(chain, pulled_scene(radius, pull, 2e-4, apart), twist);
  Ply ply;
  constexpr double still = 1e-4;  // cm/s

  constexpr int most_steps = 4000;
  constexpr double longest = 0.3;  // s
  ply.at_rest = rod.relax(still, most_steps, longest);
  ply.bodies = last + 1;
  const auto [angle, apart_by] = shape_of(rod);
  ply.angle = angle;
  ply.radius = apart_by / radius;
  ply.force = pull * apart_by * apart_by / force_at(angle);
  ply.moment = rod.twisting_moment() * apart_by / moment_at(angle);
  ply.cpu = cpu_time() - begin;
  return ply;
}

}  // namespace hagfish
