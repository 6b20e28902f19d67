// Problems of rods and ropes whose answers are known, a function each.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/scene/settings.hpp"

namespace hagfish {

/// A rope without stiffness or friction lies half round a post. The pull F at its loose end is the
/// pull at its clamped one, and the post presses with F over its radius on each length of rope.
/// Figures are over F.
struct Capstan {
  int bodies = 0;
  bool at_rest = false;
  double head = 0;   ///< pull at the clamped end
  double press = 0;  ///< sum of the post's forces, whatever their ways, over pi F
  double cpu = 0;    ///< s
};
/// `link`: length of a body over the post's radius.
Capstan lie_round_post(double link);

/// A rope of clasp.hpp in MuJoCo: a chain of capsules, whose contacts are soft.
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

/// A long twisted rod under tension has wound up a loop of itself: a ply of two strands, helices
/// that touch each other all along, between two straight tails (Clauvelin, Audoly, Neukirch,
/// "Elasticity and electrostatics of plectonemic DNA", Biophys. J. 96, 2009).
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

/// A smooth motion: an elastic rod of universal joints, clamped at its head, is bent and released.
/// It bends with a viscosity of 0.02 s times its rigidity, and touches nothing. The rod after 0.4
/// of the period of its slowest small bend, in so many equal steps.
struct ReleasedRod {
  Eigen::Vector3d tail;  ///< middle of the last body, over the rod's length
  double cpu = 0;        ///< s
};
ReleasedRod release(TimeRule rule, int steps);

/// A tight open knot in a rope: a chain of uniform girth without stiffness, as sharp as a circle
/// whose tube fills it at most. Pulled to rest; nothing rubs, so that the pull sets the time that
/// it takes alone.
struct TightKnot {
  std::string type;  ///< "3_1"
  int bodies = 0;    ///< number of bodies at rest
  bool at_rest = false;
  double shortening = 0;  ///< rope less the distance of its ends, diameters
  double cpu = 0;         ///< s
};

/// `type`: 3_1, 4_1, 5_1 or 5_2. `link`: length of a body, diameters.
TightKnot tighten(const std::string& type, double link);

/// An elastic rod that gives way at a twisting moment: a straight one under tension (Greenhill), or
/// one bent into a ring (Michell). It is a chain of alternating joints.
struct TwistedRod {
  int bodies = 0;       ///< a multiple of 4
  double ratio = 1;     ///< B / C
  bool in_turn = true;  ///< chain_of()'s `in_turn`
};

/// Over that of theory.
struct GivesWay {
  double moment = 0;
  double cpu = 0;  ///< s
};

/// The rod is clamped at both ends, one of which slides along it and is pulled.
GivesWay greenhill(const TwistedRod& rod);
/// Head and tail are welded. Theory has a total twist of 2 pi sqrt(3) B / C.
GivesWay michell(const TwistedRod& rod);

/// Prints states of the Table 1 run with what another simulator can be held against in each of
/// them. As JSON: length of the animal (cm), and of each state q, qdot, the frames' places
/// (3 x N, column by column), M (row by row) and the forces of motion and gravity, nv.
void print_mirrored_states();

}  // namespace hagfish
