// Guards: checks at every step that a run's figures can still be trusted.
#pragma once

#include <bitset>
#include <string>
#include <vector>

#include "core/run/energy.hpp"
#include "core/run/momentum.hpp"
#include "core/step/outcome.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// The time since which a row of Eq. 6 has been at its cap.
struct CapWatch {
  RowId id;
  double since = 0;  ///< s
};

/// Memory of a run's guards.
struct Watch {
  std::bitset<outcome_names.size()> warned;  ///< warnings given: each cause once a run
  std::vector<CapWatch> capped;              ///< the thigmotaxis rows at their caps, by id
  Momentum made;                             ///< gain not given back since the head was last held

  bool has_warned(Outcome of) const { return warned.test(static_cast<std::size_t>(of)); }
};

/// A status of this outcome and message if `action` is to stop. Else ok, and the message joins
/// `warnings` if it is the first of its outcome.
Status report(Outcome outcome, const std::string& message, GuardAction action, Watch& watch,
              std::vector<std::string>& warnings);

/// Checks body speeds of a solved step before anything moves, for an observer who moves with
/// `observer` (cm/s): over guard.speed, or so far in one step that its path cannot be checked
/// (most_path_samples times constraints.stride).
Status guard_speed(const Eigen::Matrix3Xd& centre_velocity, const Eigen::Vector3d& observer,
                   const Scene& scene);

/// Checks the state after a step, and the deepest overlap on the way there (`crossing`, cm).
/// Messages name the bodies or the joint with the largest violation, and the setting that would
/// help.
Status guard_state(const Model& model, const ObservedState& after, double crossing,
                   const Scene& scene, Watch& watch, std::vector<std::string>& warnings);

/// Checks the energy that the integrator has made since the sum of its own terms was lowest
/// (impacts lower it). The reference is what there was before this step: the largest kinetic and
/// elastic energy, and the loss by drag and damping. With action `hold` and Euler's rule the excess
/// is taken back: one factor scales the velocities of `after` down, and the ledger books it. Where
/// momentum is kept, all of this is about the centre of mass. `passing` as passing_momentum.
Status guard_energy(const StepInput& in, double passing, ObservedState& after, EnergyLedger& ledger,
                    Watch& watch, std::vector<std::string>& warnings);

/// The share of the most momentum that a free body could have with its largest energy so far at
/// which guard_momentum() warns. A path through the water that is off by it cannot be seen.
constexpr double momentum_gain = 0.001;

/// Warns if the integrator has made more momentum than momentum_gain since the head was last held.
/// The ledgers are those `before` the step `in` and after it. `passing` as above.
void guard_momentum(const StepInput& in, double passing, const MomentumLedger& before,
                    const MomentumLedger& now, const EnergyLedger& energy, Watch& watch,
                    std::vector<std::string>& warnings);

/// Warns of a row of Eq. 6 whose force has been at its cap for longer than the scene permits, and
/// names the rows that resist it most. It does not warn in the phase `pull`, where rows may give
/// all they can. `kin` is that of the step's start.
void guard_cap(const Model& model, const Kinematics& kin, const Scene& scene, Phase phase,
               const StepSolution& step, double time, Watch& watch,
               std::vector<std::string>& warnings);

/// Warns of what the animal cannot do in the step from `time`, and names the joint: a rest shape
/// beyond a joint's limit by more than `guard.limit_violation`, or muscles at their capacity.
void guard_muscles(const Model& model, const Scene& scene, const Control& control, double time,
                   Watch& watch, std::vector<std::string>& warnings);

}  // namespace hagfish
