// Two ropes hook into each other at right angles, each pulled at both of its ends: the tight clasp
// (Cantarella, Fu, Kusner, Sullivan, Wrinkle, "Criticality for the Gehring link problem", Geometry
// and Topology 10, 2006).
#pragma once

namespace hagfish {

/// In diameters of the rope, which has no stiffness.
struct Clasp {
  int bodies = 0;
  bool at_rest = false;
  double tips = 0;  ///< from the middle line of one rope to that of the other one where they hook
  double load = 0;  ///< that one rope puts on the other one, over the pull: 2
  double cpu = 0;   ///< s
};
Clasp hook(double link);

/// The distance of the tips in theory. Where the one rope's tangent has turned by t from its tip,
/// it touches the other one where that has turned by u, sin t + sin u = 1.
double ideal_tips();

}  // namespace hagfish
