#include "experiments/mechanics/mechanics.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/rod.hpp"

namespace hagfish {

ReleasedRod release(TimeRule rule, int steps) {
  const double begin = cpu_time();
  constexpr int bodies = 20;
  constexpr double length = 40;    // cm
  constexpr double bending = 400;  // dyn cm^2; with 1e-3 g/cm the slowest bend takes 4.5 s

  constexpr double until = 1.8;  // s
  constexpr double most = 1;     // rad, at the tail
  std::vector<Eigen::Vector3d> links;
  for (int b = 0; b < bodies; ++b) {
    const double left = 1 - static_cast<double>(b) / bodies;
    // Bends fade towards the free end, as they do in a rod that bends by its own inertia.
    const double angle = most * (1 - left * left * left);
    const double about = 1.5 * (1 - left);
    links.emplace_back(std::cos(angle), std::sin(angle) * std::cos(about),
                       std::sin(angle) * std::sin(about));
  }
  const Rod rod{.radius = 1, .bending = bending, .bending_damping = 0.02 * bending, .drag = 0};
  Scene scene = pulled_scene(rod.radius, 0, until / steps, std::numeric_limits<double>::infinity());
  scene.time.rule = rule;
  Pulled released(chain_of(rod, length / bodies, links), scene);
  for (int k = 0; k < steps; ++k) released.step();
  return {released.kin().centre.rightCols<1>() / length, cpu_time() - begin};
}

}  // namespace hagfish
