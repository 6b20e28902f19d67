// What became of one cell of the failure map: its outcome by name and the figures behind it.
#pragma once

#include <string>

#include "core/chain/start.hpp"
#include "core/run/simulation.hpp"
#include "core/run/slide.hpp"
#include "experiments/judge/expectations.hpp"

namespace hagfish {

/// Figures of a run up to now.
struct StressFigures {
  double time = 0;              ///< reached, s
  double energy_gain = 0;       ///< largest, as ExpectSettings::energy_gain has it
  double penetration = 0;       ///< deepest at the end of any step, cm
  double path_penetration = 0;  ///< deepest of strands at and between steps, cm
  double limit_violation = 0;   ///< largest, rad
  std::string knot;             ///< type as last seen
};

/// Mechanical energy of a moment, erg.
struct EnergyState {
  double total = 0;   ///< kinetic, elastic and gravity
  double put_in = 0;  ///< energy put in by script and thigmotaxis since the start
};

/// Watches a run step by step, whoever takes the steps, and judges it by the scene's [expect]:
/// penetration, limits, energy gain, knot, KKT residual and Eq. 6
/// (experiments/judge/expectations.hpp).
class StressJudge {
 public:
  /// The model and the scene are referred to. `energy` is that of the start.
  StressJudge(const Model& model, const Scene& scene, const State& start, double energy);

  /// A step from `before` to `after`, where all looks like `observation`, at the time of `after`.
  void see(const State& before, const State& after, const Observation& observation, double time,
           const EnergyState& energy);
  /// What the core's controller and solver say of its step.
  void see_control(const StepRecord& record);

  const StressFigures& figures() const { return figures_; }

  /// The outcome of a run that came to its end. In this order: tunnelled, knot lost, energy gain,
  /// penetration, limits, solver failed (KKT), never tied, capped (Eq. 6), ok.
  Status ended() const;
  /// Status of a run that an error stopped: by its cause. Penetration, limits, speed and a lost
  /// knot follow from the first three above: these are the status where they hold.
  Status stopped(const StepError& error) const;

 private:
  void see_path(const State& before, const State& after, const Kinematics& kin);
  void see_knot(const Observation& observation, double time);
  /// Tunnelled, knot lost, energy gain, or ok.
  Status root_cause() const;
  /// Whether the thigmotaxis did what the scene expects.
  Status thigmotaxis() const;

  const Model& model_;
  const Scene& scene_;
  StressFigures figures_;
  double thinnest_ = 0;  ///< radius, cm
  ContactSearch search_;
  EnergyGain gain_;
  Phase phase_;
  bool knotted_at_start_ = false;
  double knot_seen_ = 0;  ///< s
  std::string lost_;      ///< what the knot became before its release
  bool tied_ = false;     ///< the controller took the knot as tied
  SlideWatch slides_;
  long slide_steps_ = 0, slide_met_ = 0;
  double kkt_ = 0;
};

}  // namespace hagfish
