// Elastic rods as chains of bodies, at rest under a pull: overdamped, with steps as long as their
// slowest motions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace hagfish {

/// A uniform rod without mass to speak of.
struct Rod {
  double radius = 0;           ///< cm
  double bending = 0;          ///< rigidity B, dyn cm^2
  double bending_damping = 0;  ///< rate form of B, dyn cm^2 s
  double twisting = 0;  ///< rigidity C, dyn cm^2: joints alternate; 0: universal joints alone
  double sharpest = 0;  ///< curvature that no joint exceeds, 1/cm; 0: any
  bool in_turn = true;  ///< universal joints turn about Y before Z and Z before Y in turn
  double drag = 1;      ///< drag across the rod, a tenth of it along, g / (s cm)
};

/// A chain that stands for the rod, with these links (unit vectors, head to tail) of `link` (cm)
/// each: its model and its state. The first link is turned to +X. Alternating joints bend at every
/// second link alone, so links go in pairs; their twist joints turn by `twist` (rad) each. A joint
/// that turns about Y before Z twists the rod by half the product of its angles: with the next one
/// the other way round, the twists of both add up to none.
struct RodChain {
  Model model;
  State state;
};
RodChain chain_of(const Rod& rod, double link, const std::vector<Eigen::Vector3d>& links,
                  double twist = 0);

/// Points of a curve as unit links of the same length, by walking along it.
std::vector<Eigen::Vector3d> links_along(const std::vector<Eigen::Vector3d>& curve, double link);

/// Catmull-Rom through the columns `first` to `last` of `points`, but for the ends that have no
/// neighbours; fifty points from one to the next.
std::vector<Eigen::Vector3d> smooth_through(const Eigen::Matrix3Xd& points, int first, int last);

/// The scene in which it is pulled by `force` (dyn) along +X at its last body, the head clamped,
/// with steps of `step` (s). Parts with less rod than `apart` (cm) between them never touch.
Scene pulled_scene(double radius, double force, double step, double apart);

/// The push (dyn) of one contact between two places along the rod, in bodies from the head.
struct ContactForce {
  double head = 0, tail = 0;
  double force = 0;
};

/// A force (dyn) on the middle of a body, and a moment (dyn cm).
struct Load {
  int body = 0;
  Eigen::Vector3d force;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};
using Loads = std::function<std::vector<Load>(const Kinematics&)>;

/// The rod on its way to rest.
class Pulled {
 public:
  /// `loads` act besides the scene's pull at the tail.
  Pulled(RodChain chain, Scene scene, const Loads& loads = {});
  const Model& model() const { return chain_.model; }
  const StepSolution& solution() const { return record_.solution; }
  const Kinematics& kin() const { return sim_.now.observation.kin; }
  /// Steps, each as long as lets no body move further than a third of the radius, until in some
  /// steps together none has moved at more than `still` (cm/s); false: not within so many.
  /// No step is longer than `longest` (s): long ones leave the directions of contact forces behind.
  bool relax(double still, int most_steps, double longest = 2);
  /// One more, as long as the last one.
  void step();
  std::string knot() const;
  /// Forces of contacts in the last step.
  std::vector<ContactForce> contact_forces() const;
  /// Mean of the twist joints' moments, dyn cm.
  double twisting_moment() const;
  /// Sum of the forces of obstacles in the last step, whatever their ways, dyn.
  double press() const;
  /// Force (dyn) of the part of the rod from `body` on upon the part before it.
  Eigen::Vector3d force_behind(int body) const;
  /// Bend between two places over the length between them, 1/cm; places in bodies from the head,
  /// whole at their middles. A joint's bend is spread as far as half way to the next ones that
  /// bend.
  double mean_curvature(double from, double to) const;

 private:
  RodChain chain_;
  Scene scene_;
  Simulation sim_;
  StepRecord record_;
};

}  // namespace hagfish
