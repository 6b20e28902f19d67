// The ropes of clasp.hpp in MuJoCo: chains of capsules, whose contacts are soft.
#pragma once

namespace hagfish {

struct MujocoRope {
  double step = 0.01;  ///< s; contacts yield within two of them, the least that MuJoCo has
  double density = 1;  ///< g/cm: contacts are the harder the heavier the rope, and it is the slower
};

struct MujocoClasp {
  int bodies = 0;
  bool at_rest = false;  ///< the tips move no more
  double tips = 0;       ///< Clasp::tips
  double overlap = 0;    ///< deepest of two capsules, diameters
  double cpu = 0;        ///< s
};
MujocoClasp hook_in_mujoco(double link, const MujocoRope& rope);

}  // namespace hagfish
