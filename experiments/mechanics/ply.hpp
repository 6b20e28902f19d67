// A long twisted rod under tension has wound up a loop of itself: a ply of two strands, helices
// that touch each other all along, between two straight tails (Clauvelin, Audoly, Neukirch,
// "Elasticity and electrostatics of plectonemic DNA", Biophys. J. 96, 2009).
#pragma once

namespace hagfish {

struct PlyInput {
  double angle = 0.35;    ///< angle of the strands to their axis in theory, rad
  double per_radius = 2;  ///< bodies to a radius of the rod
};

/// A ply at rest, without friction. What theory has is that of the measured angle.
struct Ply {
  int bodies = 0;
  bool at_rest = false;
  double angle = 0;   ///< angle in the middle of the ply, rad
  double radius = 0;  ///< half of the strands' distance there, over the rod's
  double force = 0;   ///< pull, over that of theory
  double moment = 0;  ///< twisting moment of the strands, over that of theory
  double cpu = 0;     ///< s
};
Ply wind_up(const PlyInput& input);

}  // namespace hagfish
