#include "experiments/mechanics/loose_knot.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "experiments/mechanics/rod.hpp"

namespace hagfish {
namespace {

constexpr double pull = 0.5;  // dyn: with B = 1 dyn cm^2 the thin rod's loop has a radius of 1 cm
constexpr double tail_length = 7;  // cm, five lengths sqrt(B / F) over which bends fade
constexpr double still = 2e-5;     // cm/s: drag on all of the rod is then 0.01 % of the pull
constexpr int most_steps = 4000;

/// Contacts with a force, sorted along the head's strand, where they are closer than `apart` bodies
/// taken as one touch.
std::vector<Touch> touches_of(const Pulled& rod, double apart) {
  std::vector<Touch> single;
  for (const ContactForce& contact : rod.contact_forces()) {
    single.push_back({contact.head, contact.tail, 0, contact.force / pull});
  }
  std::ranges::sort(single, {}, &Touch::head);
  std::vector<Touch> touches;
  double first = 0;
  double last = 0;
  for (const Touch& next : single) {
    if (touches.empty() || next.head - last > apart) {
      touches.push_back(next);
      first = next.head;
    } else {
      Touch& touch = touches.back();
      const double share = next.force / (touch.force + next.force);
      touch.head += share * (next.head - touch.head);
      touch.tail += share * (next.tail - touch.tail);
      touch.force += next.force;
      touch.extent = next.head - first;
    }
    last = next.head;
  }
  return touches;
}

}  // namespace

std::vector<Eigen::Vector3d> loose_curve(const LooseKnotInput& input, double tail) {
  const double thin = std::sqrt(input.radius);
  const double loop = std::sqrt(1 + (input.crossings == 3 ? 1.4 : 2.4) * thin);
  const double braid = (input.crossings == 3 ? 4.8 : 10.0) * thin;
  const double end = 0.6 * loop;
  const auto strand = [&](double x, double side) -> Eigen::Vector3d {
    const double apart = loop - std::sqrt(loop * loop - x * x);
    const double turned = 0.5 + 0.5 * std::tanh(1.5 * x / braid) / std::tanh(1.5 * end / braid);
    const double angle = std::numbers::pi * input.crossings * turned;
    const Eigen::Vector3d across(0, std::cos(angle), std::sin(angle));
    return Eigen::Vector3d(x, 0.5 * apart, 0) +
           side * 0.5 * std::hypot(2.3 * input.radius, apart) * across;
  };
  constexpr int samples = 20000;
  std::vector<Eigen::Vector3d> curve;
  const auto along = [&](auto point) {
    for (int i = 0; i < samples; ++i) curve.push_back(point(static_cast<double>(i) / samples));
  };
  const double from = std::asin(0.6);
  along([&](double s) { return Eigen::Vector3d(-end - tail * (1 - s), 0, 0); });
  along([&](double s) { return strand(end * (2 * s - 1), -1); });
  along([&](double s) {
    const double angle = from + 2 * (std::numbers::pi - from) * s;
    return Eigen::Vector3d(loop * std::sin(angle), loop * (1 - std::cos(angle)), 0);
  });
  along([&](double s) { return strand(end * (2 * s - 1), 1); });
  along([&](double s) { return Eigen::Vector3d(end + tail * s, 0, 0); });
  return curve;
}

LooseKnot pull_loose_knot(const LooseKnotInput& input) {
  const std::clock_t begin = std::clock();
  const double link = std::sqrt(input.radius) / input.per_braid;
  const Rod material{.radius = input.radius, .bending = 1, .twisting = input.ratio};
  constexpr double apart = 3;  // cm: the loop has some 6
  Pulled rod(chain_of(material, link, links_along(loose_curve(input, tail_length), link)),
             pulled_scene(input.radius, pull, 2e-4, apart));
  LooseKnot knot;
  knot.at_rest = rod.relax(still, most_steps);
  knot.bodies = rod.model().body_count();
  knot.type = rod.knot();
  knot.touches = touches_of(rod, input.per_braid);
  if (!knot.touches.empty()) {
    const double from = knot.touches.back().head;
    const double to = knot.touches.front().tail;
    const auto top = static_cast<int>(std::lround(0.5 * (from + to)));
    const double bend = rod.mean_curvature(from, to);
    const double top_bend = rod.mean_curvature(top - input.per_braid, top + input.per_braid);
    knot.load = pull / (bend * bend);
    knot.integral = rod.force_behind(top).dot(rod.kin().rotation[top].col(0)) / pull +
                    0.5 * top_bend * top_bend / pull;
  }
  knot.cpu = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return knot;
}

}  // namespace hagfish
