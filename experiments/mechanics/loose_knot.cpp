#include "experiments/mechanics/loose_knot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/rod.hpp"

namespace hagfish {
namespace {

constexpr double pull = 0.5;  // dyn: with B = 1 dyn cm^2 the thin rod's loop has a radius of 1 cm
constexpr double tail_length = 7;  // cm, five lengths sqrt(B / F) over which bends fade
constexpr double still = 2e-5;     // cm/s: drag on all of the rod is then 0.01 % of the pull
constexpr int most_steps = 4000;

/// The touch of all these contacts, sorted along the head's strand.
Touch one_touch(std::span<const ContactForce> contacts) {
  constexpr double fringe = 0.02;  // of the force, at each end: what flickers
  Touch touch;
  for (const ContactForce& one : contacts) touch.force += one.force;
  double so_far = 0;
  double first = contacts.back().head;
  for (const ContactForce& one : contacts) {
    touch.head += one.force / touch.force * one.head;
    touch.tail += one.force / touch.force * one.tail;
    if (so_far < (1 - fringe) * touch.force) touch.extent = one.head - first;
    so_far += one.force;
    if (so_far > fringe * touch.force) first = std::min(first, one.head);
  }
  return touch;
}

/// Contacts that are closer than `apart` bodies along the head's strand are one touch.
std::vector<Touch> touches_of(std::vector<ContactForce> contacts, double apart) {
  std::ranges::sort(contacts, {}, &ContactForce::head);
  std::vector<Touch> touches;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= contacts.size(); ++i) {
    if (i < contacts.size() && contacts[i].head - contacts[i - 1].head <= apart) continue;
    touches.push_back(one_touch(std::span(contacts).subspan(first, i - first)));
    first = i;
  }
  return touches;
}

/// The body half way round the loop.
int middle(const std::vector<ContactForce>& forces) {
  const double from = std::ranges::max(forces, {}, &ContactForce::head).head;
  const double to = std::ranges::min(forces, {}, &ContactForce::tail).tail;
  return static_cast<int>(std::lround(0.5 * (from + to)));
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
  const double begin = cpu_time();
  const double link = std::sqrt(input.radius) / input.per_braid;
  const Rod material{
      .radius = input.radius, .bending = 1, .bending_damping = 0.1, .twisting = input.ratio};
  constexpr double apart = 3;  // cm: the loop has some 6
  Pulled rod(chain_of(material, link, links_along(loose_curve(input, tail_length), link)),
             pulled_scene(input.radius, pull, 2e-4, apart));
  LooseKnot knot;
  knot.at_rest = rod.relax(still, most_steps);
  knot.bodies = rod.model().body_count();
  knot.type = rod.knot();
  if (rod.contact_forces().empty()) throw std::runtime_error("a loose knot touches itself nowhere");
  // The force between two strands goes to and fro between contacts beside each other: means of
  // some steps.
  std::vector<ContactForce> forces;
  Eigen::Vector3d behind = Eigen::Vector3d::Zero();
  const int top = middle(rod.contact_forces());
  constexpr int averaged = 20;
  for (int k = 0; k < averaged; ++k) {
    rod.step();
    for (const ContactForce& one : rod.contact_forces()) {
      forces.push_back({one.head, one.tail, one.force / averaged / pull});
    }
    behind += rod.force_behind(top) / averaged;
  }
  knot.touches = touches_of(forces, input.per_braid);
  const double bend = rod.mean_curvature(knot.touches.back().head, knot.touches.front().tail);
  const double top_bend = rod.mean_curvature(top - input.per_braid, top + input.per_braid);
  knot.load = pull / (bend * bend);
  knot.integral =
      behind.dot(rod.kin().rotation[top].col(0)) / pull + 0.5 * top_bend * top_bend / pull;
  knot.cpu = cpu_time() - begin;
  return knot;
}

}  // namespace hagfish
