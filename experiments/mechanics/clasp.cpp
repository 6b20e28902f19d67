#include "experiments/mechanics/clasp.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "experiments/common/cpu_time.hpp"

namespace hagfish {
namespace {

constexpr double radius = 0.5;  // cm: lengths are in diameters
constexpr double leg = 3;       // cm
constexpr double loose = 0.3;   // cm, that the tips are further apart at first

struct BothRopes {
  std::vector<Eigen::Vector3d> curve;
  double first_end = 0, second_begin = 0;  ///< cm from the head
};

BothRopes both_ropes() {
  BothRopes ropes;
  double length = 0;
  const auto to = [&](double x, double y, double z) {
    const Eigen::Vector3d point(x, y, z);
    if (!ropes.curve.empty()) length += (point - ropes.curve.back()).norm();
    ropes.curve.push_back(point);
  };
  constexpr int samples = 4000;
  const auto along = [&](auto point) {
    for (int i = 0; i < samples; ++i) point(static_cast<double>(i) / samples);
  };
  const double pi = std::numbers::pi;
  const double far = 1 - loose + leg;  // where the second rope's legs end
  along([&](double s) { to(leg * (s - 1), 0, 1); });
  along([&](double s) { to(std::sin(pi * s), 0, std::cos(pi * s)); });
  along([&](double s) { to(-leg * s, 0, -1); });
  ropes.first_end = length;
  along([&](double s) { to(-leg - 1.5 * std::sin(pi * s), 0, -2.5 + 1.5 * std::cos(pi * s)); });
  along([&](double s) { to(-leg + s * (leg + far), s, -4); });
  along([&](double s) { to(far + 2 * std::sin(pi * s), 1, -2 - 2 * std::cos(pi * s)); });
  ropes.second_begin = length;
  along([&](double s) { to(far - leg * s, 1, 0); });
  along([&](double s) { to(far - leg - std::sin(pi * s), std::cos(pi * s), 0); });
  along([&](double s) { to(far - leg * (1 - s), -1, 0); });
  return ropes;
}

/// How far along X the rope between two bodies comes.
template <class Less>
double furthest(const Eigen::Matrix3Xd& centre, int first, int last, Less less) {
  const auto x = [](const Eigen::Vector3d& point) { return point.x(); };
  return std::ranges::max(smooth_through(centre, first, last), less, x).x();
}

}  // namespace

ClaspChain clasp_chain(double link) {
  const BothRopes ropes = both_ropes();
  ClaspChain both;
  both.chain =
      chain_of({.radius = radius, .bending_damping = 1}, link, links_along(ropes.curve, link));
  both.first_end = static_cast<int>(ropes.first_end / link) - 1;
  both.second_begin = static_cast<int>(ropes.second_begin / link) + 1;
  const Eigen::Vector3d force(clasp_pull, 0, 0);
  both.loads = {{both.first_end, -force}, {both.second_begin, force}};
  return both;
}

double ClaspChain::tips(const Eigen::Matrix3Xd& centre) const {
  return furthest(centre, 0, first_end, std::less()) -
         furthest(centre, second_begin, static_cast<int>(centre.cols()), std::greater());
}

Clasp hook(double link) {
  const double begin = cpu_time();
  const ClaspChain both = clasp_chain(link);
  Pulled rope(both.chain, pulled_scene(radius, clasp_pull, 1e-3, clasp_apart),
              [&](const Kinematics&) { return both.loads; });
  Clasp clasp;
  constexpr double still = 2e-5;  // cm/s
  constexpr int most_steps = 6000;
  clasp.at_rest = rope.relax(still, most_steps);
  clasp.bodies = rope.model().body_count();
  clasp.tips = both.tips(rope.kin().centre);
  const int between = (both.first_end + both.second_begin) / 2;
  clasp.load = 1 - rope.force_behind(between).x() / clasp_pull;
  clasp.cpu = cpu_time() - begin;
  return clasp;
}

double ideal_tips() {
  const auto across = [](double turned) {
    const double sine = std::sin(turned);
    const double other = 1 - sine;
    if (sine <= 0 || other <= 0) return sine;
    const double steep = sine * sine / (1 - sine * sine);
    return std::sqrt(steep / (1 + steep + other * other / (1 - other * other)));
  };
  // Trapezia in the tangent's direction: 1e-7 off with these.
  constexpr int parts = 1000000;
  double tips = 0;
  for (int i = 0; i < parts; ++i) {
    const double from = 0.5 * std::numbers::pi * i / parts;
    const double to = 0.5 * std::numbers::pi * (i + 1) / parts;
    tips += std::tan(0.5 * (from + to)) * (across(to) - across(from));
  }
  return tips;
}

}  // namespace hagfish
