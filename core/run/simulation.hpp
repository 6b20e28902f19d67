// A run of a scene, step by step: observe, decide, solve (Eqs. 1-4), advance (Eq. 2), book.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/run/controller.hpp"
#include "core/run/energy.hpp"
#include "core/run/guard.hpp"
#include "core/run/momentum.hpp"
#include "core/step/step.hpp"

namespace hagfish {

/// What a step changes before it is sure to be taken, as it was: storage of take_step.
struct BeforeStep {
  ControllerState controller;
  WarmStart warm;
  EnergyLedger ledger;
  MomentumLedger momentum;
  Watch watch;
  Candidates candidates;  ///< of the search
};

/// Set while a step is under way, by which a second one of the same simulation is refused. A copy
/// has no step under way.
class StepUnderWay {
 public:
  StepUnderWay() = default;
  StepUnderWay(const StepUnderWay&) {}
  StepUnderWay& operator=(const StepUnderWay&) { return *this; }

  /// Whether it was not set before.
  bool begin() { return !set_.exchange(true); }
  void end() { set_ = false; }

 private:
  std::atomic<bool> set_ = false;
};

/// All that changes while a scene runs. Copies go on independently of each other.
struct Simulation {
  std::int64_t step = 0;  ///< steps taken
  Moment now;
  ContactSearch search;  ///< that found its contacts
  ControllerState controller;
  StepSolver solver;
  EnergyLedger ledger;
  MomentumLedger momentum;
  Watch watch;
  BeforeStep before;
  NamedLaw named_law = {};
  ControlLaw law = {};  ///< of its own, where the scene says so (control_law.hpp); else empty
  StepUnderWay under_way = {};
};

/// As the scene starts, at time 0. `back_end`: one of box_qp_solver_names(). Throws
/// std::invalid_argument otherwise, and of a model without bodies.
Simulation start(const Model& model, const Scene& scene, const std::string& back_end);

/// From a state of another run: `controller` says which phase it is in. Throws as start, and
/// std::invalid_argument of a state that is not of `model`.
Simulation start_from(const Model& model, const Scene& scene, const std::string& back_end,
                      State state, ControllerState controller, std::int64_t step);

/// Goes on in another scene of the same chain, with another time step at the same time: contacts
/// are found anew, energy and momentum that the change brings count as there from the start, and a
/// memory or rest shape that the scene's law does not have is dropped.
/// Throws std::invalid_argument where the state is not of `model`, or its time no multiple of the
/// frame interval.
void change_scene(const Model& model, const Scene& before, const Scene& scene, Simulation& sim);

inline double time_of(const Simulation& sim, const Scene& scene) {
  return static_cast<double>(sim.step) * scene.time.step;
}

/// The scene is over: the knot has been gone for long enough, or its duration has passed.
bool finished(const Simulation& sim, const Scene& scene);

/// What a step began with and did. `sim` has moved on by the time it is read.
struct StepRecord {
  std::int64_t step = 0;
  double time = 0;  ///< s
  Moment moment;    ///< at `time`
  ControllerState controller;
  Control control;
  StepSolution solution;
  EnergyLedger ledger;      ///< up to `time`
  MomentumLedger momentum;  ///< up to `time`
  double head_drift = 0;    ///< cm; 0 while the head is free
  double crossing = 0;      ///< deepest overlap on the way to the next state, cm; 0 of a short way
  double left_out = 0;      ///< of the step's motion, at its end, where strands meet too fast, s
  /// What this step gave rise to for the first time (guard.hpp).
  std::vector<std::string> warnings;
};

/// Throws std::invalid_argument where `sim` is not of `model`, as one that was moved from.
void require_of(const Model& model, const Simulation& sim);

/// Takes one step, writing into the storage of `record`. Throws StepError, with the outcome by
/// name, where it cannot; std::invalid_argument where `sim` is not of `model`; std::logic_error
/// where a step of `sim` is under way, as in a law or another thread. Whatever it throws, `sim` is
/// then as it was, but for storage whose contents do not matter; a step with another scene goes on
/// as if nothing had been. `record` then has its step and time, the controller as far as it came
/// and, where a guard refused the moment that the step led to, that moment.
void take_step(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record);
StepRecord take_step(const Model& model, const Scene& scene, Simulation& sim);

}  // namespace hagfish
