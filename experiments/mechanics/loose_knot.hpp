// Loose open knots (2, c) in a long elastic rod, pulled at its ends without friction (Audoly,
// Clauvelin, Neukirch, "Elastic knots", Phys. Rev. Lett. 99, 2007): c strands' crossings in a
// braid, closed by a loop that is nearly a circle.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hagfish {

struct LooseKnotInput {
  int crossings = 3;     ///< 3: trefoil, 5: cinquefoil
  double radius = 0.01;  ///< radius of the rod, times the loop's radius in the thin limit: ε²
  double per_braid = 3;  ///< bodies to a length ε of that radius, which the braid is some of
  double ratio = 0;      ///< C / B; 0: universal joints alone, a rod that cannot twist
};

/// A stretch of the rod that touches another one. At an isolated point a chain spreads the force
/// over contacts that are within one body of each other.
struct Touch {
  double head = 0, tail = 0;  ///< meeting of both strands, bodies from the head: means by force
  double extent = 0;          ///< length from first contact to last, bodies, but for fringes
  double force = 0;           ///< sum, over the pull
};

/// A loose knot at rest. The pull is F, the bending rigidity B.
struct LooseKnot {
  int bodies = 0;
  std::string type;      ///< "3_1"
  bool at_rest = false;  ///< no body moves faster than drag makes matter
  double load = 0;       ///< F R² / B, 1 / R: mean curvature from the first touch to the last
  double integral =
      0;  ///< (tension + B κ² / 2) / F half way between them: 1 all along a frictionless rod
  std::vector<Touch> touches;  ///< touches along the head's strand
  double cpu = 0;              ///< s
};
LooseKnot pull_loose_knot(const LooseKnotInput& input);

/// A curve near it, with tails of `tail` along X: a circle, 1 in radius, whose two ends lie along
/// the tails and wind about each other `crossings` half turns.
std::vector<Eigen::Vector3d> loose_curve(const LooseKnotInput& input, double tail);

}  // namespace hagfish
