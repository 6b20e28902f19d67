// The momentum ledger: what an animal's linear and angular momentum come from. Only water can push
// or turn an animal that nothing holds, so that
//   momentum - initial = drag + outside + integrator + given back
// with nothing outside shows that it ties its knot by itself.
//
// Impulses are h times the forces of Eq. 1, also of a step that ends early. What the rule gains by
// itself is written down from its own formula, not as the remainder: the ledger closes to rounding,
// or the forces are not what they claim. While nothing holds the head it is given back after each
// step, where the scene says so (TimeSettings::momentum).
#pragma once

#include "core/run/energy.hpp"
#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// Linear momentum, g cm/s, and angular momentum about the centre of mass, g cm²/s; or an impulse,
/// dyn s and dyn cm s. World axes.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();

  Momentum& operator+=(const Momentum& more);
  Momentum& operator-=(const Momentum& less);
  Momentum operator+(const Momentum& more) const { return Momentum(*this) += more; }
  Momentum operator-(const Momentum& less) const { return Momentum(*this) -= less; }
  Momentum operator*(double factor) const { return {factor * linear, factor * angular}; }
};

/// The moment about `centre` (cm, world) of forces on bodies whose sum, generalised, is `force`
/// (nv): all bodies hang on the root, so that its first six entries tell. dyn cm, world.
Eigen::Vector3d moment_of_root(const Eigen::VectorXd& force, const Kinematics& kin,
                               const Eigen::Vector3d& centre);

/// Of all bodies, g.
double mass_of(const Model& model);

/// Of all bodies at kin's velocities.
Momentum momentum_of(const Model& model, const Kinematics& kin);

/// Impulses, the integrator's and what was given back are running totals.
struct MomentumLedger {
  Momentum initial, momentum;
  Momentum drag;
  Momentum outside;  ///< tip, head clamp, head plate, gravity; moments of Eq. 6 at the centreline
  /// As bodies turn within the step while their velocities do not, against what the explicit
  /// Coriolis force does; and what guards take from the velocity.
  Momentum integrator;
  Momentum given_back;  ///< what steps with a free head would have made, with its sign turned
};

/// Opens the ledger at a moment.
MomentumLedger open_momentum(const Model& model, const Moment& now);

/// Whether a step by `control` keeps momentum: nothing holds the head, and the scene says so.
bool keeps_momentum(const Scene& scene, const Control& control);

/// Where the centre of mass is when the step `in`, as solved at `place`, has moved for the time
/// `travelled` (s) from `now`: moved by the momentum that the step moves by, which Eq. 1 has from
/// that before and from the forces; cm, world.
Eigen::Vector3d centre_after(const StepInput& in, const StepPlace& place, const StepSolution& step,
                             const Momentum& before, double travelled);

/// Books the step `in` from where the ledger stands, by its solution at `place`, to `next`. Where
/// it keeps momentum, `next` is first given that which the impulses leave, by a motion of the whole
/// as one rigid body. One factor on the velocities between its parts keeps the kinetic energy;
/// where none does, nothing is given back. `energy` books what is left.
void book_momentum(const StepInput& in, const StepPlace& place, const StepSolution& step,
                   Moment& next, EnergyLedger& energy, MomentumLedger& ledger);

}  // namespace hagfish
