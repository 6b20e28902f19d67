// What every run is watched for: signs that its figures are no longer to be believed.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

#include "core/run/energy.hpp"
#include "core/run/momentum.hpp"
#include "core/step/outcome.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// Since when a thigmotaxis row has been at its cap.
struct CapWatch {
  std::int64_t id = 0;  ///< Row::id
  double since = 0;     ///< s
};

/// What a run remembers of its watches.
struct Watch {
  std::bitset<outcome_count> warned;  ///< warnings given: each cause once a run
  std::vector<CapWatch> capped;       ///< the thigmotaxis rows at their caps, by id
  Momentum made;                      ///< by the integrator since the head was last held

  bool has_warned(Outcome of) const { return warned.test(static_cast<std::size_t>(of)); }
};

/// A status of this outcome and message where the scene stops at it; else ok, and the message is
/// added to `warnings` the first time.
Status report(Outcome outcome, const std::string& message, GuardAction action, Watch& watch,
              std::vector<std::string>& warnings);

/// Body speeds a step has come to, before it moves anything: over guard.speed, or so far in one
/// step that its path cannot be looked along (most_path_samples times constraints.stride).
Status guard_speed(const Eigen::Matrix3Xd& centre_velocity, const Scene& scene);

/// The moment that a step led to, and the deepest overlap on the way there (`crossing`, cm).
/// Messages name the bodies or joint furthest out and the setting that would help.
Status guard_state(const Model& model, const Moment& moment, double crossing, const Scene& scene,
                   Watch& watch, std::vector<std::string>& warnings);

/// Energy that the integrator has made since the sum of its own terms was lowest (impacts lower
/// it), against what there was before this step: the largest kinetic and elastic energy, and what
/// drag and damping took. Where the scene says hold and the rule is Euler's, the excess is taken
/// back: the velocities of `moment` are scaled down by one factor, and the ledger books it.
Status guard_energy(const Model& model, const Scene& scene, Moment& moment, EnergyLedger& ledger,
                    Watch& watch, std::vector<std::string>& warnings);

/// Momentum that the integrator has made since the head was last held, over guard.momentum_gain of
/// the most that a body of the largest energy so far can have: warns. The ledgers are those
/// `before` the step `in` and after it.
void guard_momentum(const StepInput& in, const MomentumLedger& before, const MomentumLedger& now,
                    const EnergyLedger& energy, Watch& watch, std::vector<std::string>& warnings);

/// A thigmotaxis row whose force has been at its cap for longer than the scene permits: warns and
/// names the rows that resist it most; not in the phase `pull`, where rows give all they may. `kin`
/// is that of the step's start.
void guard_cap(const Model& model, const Kinematics& kin, const Scene& scene, Phase phase,
               const StepSolution& step, double time, Watch& watch,
               std::vector<std::string>& warnings);

/// What the animal cannot do: warns, naming the joint, of a rest shape beyond a joint's limit by
/// more than `guard.limit_violation`, and of muscles at their capacity, in the step from `time`.
void guard_muscles(const Model& model, const Scene& scene, const Control& control, double time,
                   Watch& watch, std::vector<std::string>& warnings);

}  // namespace hagfish
