// The momentum ledger: sources of an animal's linear and angular momentum. Only water can push or
// turn an animal that nothing holds. So
//   momentum - initial = drag + outside + integrator + given back
// with nothing outside shows that the animal ties its knot by itself.
//
// Impulses are h times the forces of Eq. 1, also in a step that ends early. The gain of the rule
// itself is computed from its own formula and not as the remainder. So the ledger closes to
// rounding, or the forces are not what they claim. While nothing holds the head, this gain is given
// back after each step if the scene says so (TimeSettings::momentum).
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

/// The moment about `centre` (cm, world) of forces on bodies whose generalised sum is `force` (nv);
/// dyn cm, world. All bodies hang on the root, so the first six entries of `force` determine it.
Eigen::Vector3d moment_of_root(const Eigen::VectorXd& force, const Kinematics& kin,
                               const Eigen::Vector3d& centre);

/// Momentum of all bodies at the velocities of `kin`.
Momentum momentum_of(const Model& model, const Kinematics& kin);

/// Impulses, the integrator's and what was given back are running totals.
struct MomentumLedger {
  Momentum initial, momentum;
  Momentum drag;
  Momentum outside;  ///< tip, head clamp, head plate, gravity
  /// Gain of the integrator: bodies turn within a step while their velocities do not, and the
  /// explicit Coriolis force differs from this. Also what guards take from the velocity.
  Momentum integrator;
  Momentum given_back;  ///< minus the gain of steps with a free head
};

/// Momentum that passes through the body in a step, g cm/s: the sum of the sizes of what its parts
/// have before it, and of the impulses of its weight, the tip's force and rows from outside. It
/// does not vanish where these hold each other: figures below `passing_rounding` of it are nothing.
double passing_momentum(const StepInput& in, const StepSolution& step);
/// Rounding of the sums of a hundred bodies over up to a million steps.
inline constexpr double passing_rounding = 1e-9;

/// Opens the ledger at a moment.
MomentumLedger open_momentum(const Model& model, const ObservedState& now);

/// Place of the centre of mass when the step `in`, as solved at `place`, has moved for the time
/// `travelled` (s) from `now`; cm, world. It moves by the momentum before the step and the forces
/// of Eq. 1.
Eigen::Vector3d centre_after(const StepInput& in, const StepPlace& place, const StepSolution& step,
                             const Momentum& before, double travelled);

/// Books the step `in` from the ledger's last entry, by its solution at `place`, to `next`. If the
/// step keeps momentum, `next` first gets the momentum that the impulses leave, by a motion of the
/// whole body as one rigid body. One factor on the velocities within the body keeps the kinetic
/// energy about the centre of mass, so that no observer matters. If no factor can, the body gains a
/// little, or else its angular momentum stays as it is. `energy` books the change of all kinetic
/// energy.
void book_momentum(const StepInput& in, const StepPlace& place, const StepSolution& step,
                   ObservedState& next, EnergyLedger& energy, MomentumLedger& ledger);

}  // namespace hagfish
