#include "experiments/mechanics/mechanics.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/held_rod.hpp"

namespace hagfish {
namespace {

constexpr double length = 40;     // cm
constexpr double rigidity = 400;  // B, dyn cm^2
constexpr double tension = 5;     // dyn: the length is 4.5 times sqrt(B / T)

/// The twist of each joint, in parts of that of theory, at which the rod gives way.
GivesWay first_motion(const std::function<double(double)>& stiffness_at) {
  const double begin = cpu_time();
  const auto stable = [&](double twist) { return stiffness_at(twist) > 0; };
  double low = 0.5;
  double high = 1.3;
  if (!stable(low) || stable(high)) throw std::runtime_error("gives way where it should not");
  for (int halving = 0; halving < 14; ++halving) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return {0.5 * (low + high), cpu_time() - begin};
}

/// The chain with these links, whose twist joints turn as a moment (dyn cm) makes them.
RodChain twisted(const TwistedRod& rod, const std::vector<Eigen::Vector3d>& links, double moment) {
  const double link = length / rod.bodies;
  const double twisting = rigidity / rod.ratio;
  return chain_of(
      {.radius = 0.1, .bending = rigidity, .twisting = twisting, .in_turn = rod.in_turn}, link,
      links, moment * 2 * link / twisting);
}

/// Where a rod under tension gives way between two clamps, one of which slides: B w'''' - i M w'''
/// - T w'' = 0 for w = y + i z has solutions 1, x, exp(i s x), and those that vanish with their
/// slopes at both ends exist where this is 0. 4 B T is less than M².
double clamped_ends(double moment) {
  const double middle = 0.25 * length * moment / rigidity;
  const double apart =
      0.25 * length * std::sqrt(moment * moment - 4 * rigidity * tension) / rigidity;
  const double p = middle + apart;
  const double q = middle - apart;
  return ((std::sin(p) - p * std::cos(p)) * q * std::sin(q) -
          (std::sin(q) - q * std::cos(q)) * p * std::sin(p)) /
         (p - q);
}

double clamped_moment() {
  const double unbounded = 2 * std::sqrt(rigidity * tension);  // of an endless rod
  const double stride = 1e-4 * unbounded;
  double high = unbounded * (1 + 1e-6);
  const bool positive = clamped_ends(high) > 0;
  while ((clamped_ends(high) > 0) == positive) high += stride;
  double low = high - stride;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (low + high);
    ((clamped_ends(middle) > 0) == positive ? low : high) = middle;
  }
  return low;
}

}  // namespace

GivesWay greenhill(const TwistedRod& rod) {
  const std::vector<Eigen::Vector3d> straight(rod.bodies, Eigen::Vector3d::UnitX());
  const double moment = clamped_moment();
  return first_motion([&](double part) {
    return HeldRod(twisted(rod, straight, part * moment),
                   {.tail = {1, 2, 3, 4, 5}, .tension = tension, .level = {}})
        .least_stiffness();
  });
}

GivesWay michell(const TwistedRod& rod) {
  std::vector<Eigen::Vector3d> polygon;  // half as many sides as bodies
  for (int b = 0; b < rod.bodies; ++b) {
    const double angle = (b + 1) / 2 * 4 * std::numbers::pi / rod.bodies;
    polygon.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const double moment = 2 * std::numbers::pi * std::sqrt(3) * rigidity / length;
  return first_motion([&](double part) {
    // A ring rolls about its tangent at the weld at no cost, but for its place half way round. The
    // other two places keep it from its first motions out of the plane, which the axes of its
    // joints would set off before they are free.
    const int quarter = rod.bodies / 4;
    HeldRod ring(twisted(rod, polygon, part * moment),
                 {.tail = {0, 1, 2, 3, 4, 5}, .level = {2 * quarter, quarter, 3 * quarter}});
    if (ring.settle() > 1e-6 * moment) throw std::runtime_error("a ring does not come to rest");
    return ring.least_stiffness(2);
  });
}

}  // namespace hagfish
