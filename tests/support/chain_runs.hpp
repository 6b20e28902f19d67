// Chains for the validation tests, and their motion step by step through the project's own step.
#pragma once

#include <functional>

#include "core/step/step.hpp"

namespace hagfish {

/// A scene of step h (s) without drag, gravity or self-contact, head clamped at the origin.
Scene bare_scene(double h);

/// A chain's first body, at the origin once clamped: `length` (cm) along +X, which may be 0, with
/// unit mass (g) and inertia (g cm^2). Clamped, neither shows in the motion.
void append_root(Model& model, double length);

/// A homogeneous rod of no thickness along X: no inertia about its own axis. Mass g, length cm.
Body thin_rod(double mass, double length);

/// A chain in motion: the steps of `scene`, forward dynamics only.
class ChainRun {
 public:
  /// Starts straight and at rest; set `state` for any other start.
  ChainRun(Model chain, Scene of);

  /// One step of scene.time.step by `control`, or with `tip` on the last body's centre. Throws
  /// StepError.
  void step(const Control& control);
  void step(const TipForce& tip = {});

  /// Kinetic, gravity and elastic energy, erg.
  double energy() const;

  /// World centres of the bodies, 3 x N, cm.
  Eigen::Matrix3Xd centres() const;

  Model model;
  Scene scene;
  State state;
  double time = 0;    ///< s
  StepSolution last;  ///< the last step's, empty before the first
  Observation seen;   ///< at the start of the last step

 private:
  StepSolver solver_;
};

constexpr double post_link = 0.4;  ///< cm, a body of the chain round a post
constexpr double post_radius = 3;  ///< cm, to the chain's middle line

/// A chain without stiffness, of 86 thin rods of 0.02 g, that runs 12 cm along X to a post, half
/// round that and 13 cm back. Heavy drag and light links: it comes to rest within some tenths of a
/// second.
ChainRun chain_round_a_post();

/// Mean period (s) of `coordinate`, which swings about 0, over `periods` periods: steps the run
/// between downward crossings of 0, their times found by linear interpolation (error of third order
/// in the step, since a free swing has no curvature at its middle).
/// Throws std::runtime_error where there is no crossing within 1e6 steps.
double measured_period(ChainRun& run, const std::function<double(const State&)>& coordinate,
                       int periods);

}  // namespace hagfish
