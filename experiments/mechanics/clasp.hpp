// Two ropes hook into each other at right angles, each pulled at both of its ends: the tight clasp
// (Cantarella, Fu, Kusner, Sullivan, Wrinkle, "Criticality for the Gehring link problem", Geometry
// and Topology 10, 2006).
#pragma once

#include "experiments/mechanics/rod.hpp"

namespace hagfish {

/// Both ropes as one chain, whose middle goes round outside and carries nothing: a little apart.
/// Its links are `link` diameters long, and a diameter is 1 cm.
struct ClaspChain {
  RodChain chain;
  int first_end = 0, second_begin = 0;  ///< bodies: where the first rope ends, and the other begins
  std::vector<Load> loads;              ///< besides that at the tail, where the head is clamped
  double tips(const Eigen::Matrix3Xd& centre) const;  ///< see Clasp
};
ClaspChain clasp_chain(double link);
inline constexpr double clasp_pull = 1;   // dyn, at each of the four ends
inline constexpr double clasp_apart = 4;  // cm of rope: no rope touches itself

/// Two hooked ropes without stiffness, in diameters of the rope.
struct Clasp {
  int bodies = 0;
  bool at_rest = false;
  double tips = 0;  ///< distance of the ropes' middle lines where they hook
  double load = 0;  ///< load that one rope puts on the other one, over the pull: 2
  double cpu = 0;   ///< s
};
Clasp hook(double link);

/// The distance of the tips in theory. Where the one rope's tangent has turned by t from its tip,
/// it touches the other one where that has turned by u, sin t + sin u = 1.
double ideal_tips();

}  // namespace hagfish
