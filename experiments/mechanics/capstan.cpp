#include "experiments/mechanics/mechanics.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/rod.hpp"

namespace hagfish {

Capstan lie_round_post(double link) {
  const double begin = cpu_time();
  constexpr double rope = 0.05;  // cm: its radius; from the post's axis to its middle line it is 1
  constexpr double pull = 1;     // dyn
  constexpr double leg = 2;      // cm
  constexpr int samples = 10000;
  std::vector<Eigen::Vector3d> curve;
  for (int i = 0; i < samples; ++i) curve.emplace_back(leg * i / samples, 0, 0);
  for (int i = 0; i < samples; ++i) {
    const double angle = std::numbers::pi * i / samples;
    curve.emplace_back(leg + std::sin(angle), 1 - std::cos(angle), 0);
  }
  for (int i = 0; i < samples; ++i) curve.emplace_back(leg - leg * i / samples, 2, 0);
  RodChain chain =
      chain_of({.radius = rope, .bending_damping = 10}, link, links_along(curve, link));
  chain.model.obstacles.push_back({"post", Strand{{{leg, 1, -1}, {leg, 1, 1}}, 1 - rope}});
  constexpr double apart = 10;  // cm: the rope does not touch itself
  Pulled pulled(std::move(chain), pulled_scene(rope, -pull, 1e-3, apart));
  Capstan capstan;
  constexpr double still = 1e-7;  // cm/s
  constexpr int most_steps = 3000;
  capstan.at_rest = pulled.relax(still, most_steps);
  capstan.bodies = pulled.model().body_count();
  capstan.head = -pulled.solution().force[RowKind::head][0] / pull;
  capstan.press = pulled.press() / (std::numbers::pi * pull);
  capstan.cpu = cpu_time() - begin;
  return capstan;
}

}  // namespace hagfish
