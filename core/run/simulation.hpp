// A run of a scene, step by step: observe, decide, solve (Eqs. 1-4), advance (Eq. 2), book.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "core/control/controller.hpp"
#include "core/run/energy.hpp"
#include "core/run/guard.hpp"
#include "core/run/momentum.hpp"
#include "core/step/step.hpp"

namespace hagfish {

/// Storage of take_step: copies of what a step changes before it is certain to be taken.
using BeforeStep =
    std::tuple<ControllerState, WarmStart, EnergyLedger, MomentumLedger, Watch, Candidates>;

/// Set while a step is under way, so that a second step of the same simulation is refused. A copy
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
  ObservedState now;
  ContactSearch search;  ///< search that found its contacts
  ControllerState controller;
  StepSolver solver;
  EnergyLedger ledger;
  MomentumLedger momentum;
  Watch watch;
  BeforeStep before;
  NamedLaw named_law = {};
  ControlLaw law = {};  ///< law of its own, if the scene says so (control_law.hpp); else empty
  StepUnderWay under_way = {};
};

/// A run at time 0 of the scene. `back_end`: one of box_qp_solver_names(). Throws
/// std::invalid_argument for another name, and for a model without bodies.
Simulation start(const Model& model, const Scene& scene, const std::string& back_end);

/// A run from a state of another run; `controller` has its phase. Throws as start does, and
/// std::invalid_argument for a state that does not fit `model`.
Simulation start_from(const Model& model, const Scene& scene, const std::string& back_end,
                      State state, ControllerState controller, std::int64_t step);

/// Continues in another scene of the same chain, perhaps with another time step, at the same time.
/// Contacts are searched again. Changes of energy and momentum by the new scene count as there from
/// the start. A memory or rest shape that the scene's law does not have is dropped. Throws
/// std::invalid_argument if the state does not fit `model`, or if its time is not a multiple of the
/// frame interval.
void change_scene(const Model& model, const Scene& before, const Scene& scene, Simulation& sim);

inline double time_of(const Simulation& sim, const Scene& scene) {
  return static_cast<double>(sim.step) * scene.time.step;
}

/// Whether the scene is over: the knot has been gone for long enough, or its duration has passed.
bool finished(const Simulation& sim, const Scene& scene);

/// The start and the result of a step. `sim` has moved on when it is read.
struct StepRecord {
  std::int64_t step = 0;
  double time = 0;      ///< s
  ObservedState after;  ///< state and observation at `time`
  ControllerState controller;
  Control control;
  StepSolution solution;
  EnergyLedger ledger;      ///< ledger up to `time`
  MomentumLedger momentum;  ///< ledger up to `time`
  double head_drift = 0;    ///< cm; 0 while the head is free
  double crossing = 0;      ///< deepest overlap on the path to the next state, cm; 0 if it is short
  double left_out = 0;      ///< time at the step's end left out as strands met too fast, s
  /// Warnings that this step was the first to cause (guard.hpp).
  std::vector<std::string> warnings;
};

/// Throws std::invalid_argument if `sim` does not fit `model`, for example after a move.
void require_of(const Model& model, const Simulation& sim);

/// Takes one step, and writes into the storage of `record`. Throws StepError with a named outcome
/// if the step cannot be taken. Throws std::invalid_argument if `sim` does not fit `model`, and
/// std::logic_error if a step of `sim` is under way, for example in a law or another thread. After
/// any of these `sim` is as it was, except storage whose contents do not matter. A step with
/// another scene then works as if nothing had happened. `record` then has the step, its time and
/// the controller up to the failure. If a guard refused the state after the step, it also has that
/// state.
void take_step(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record);
StepRecord take_step(const Model& model, const Scene& scene, Simulation& sim);

}  // namespace hagfish
