// The momentum ledger: what an animal's linear momentum comes from. Only water can push an animal
// that nothing holds, so that
//   momentum - initial = drag + outside + integrator
// with nothing outside shows that it ties its knot by itself.
//
// Impulses are h times the forces of Eq. 1, also of a step that ends early. What the first-order
// rule gains by itself is written down from its own formula, not as the remainder: the ledger
// closes to rounding, or the forces are not what they claim.
#pragma once

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// World axes. Momentum in g cm/s; impulses, in dyn s, and the integrator's are running totals.
struct MomentumLedger {
  Eigen::Vector3d initial = Eigen::Vector3d::Zero();
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  Eigen::Vector3d drag = Eigen::Vector3d::Zero();
  Eigen::Vector3d outside = Eigen::Vector3d::Zero();  ///< tip, head clamp, head plate, gravity
  /// As bodies turn within the step while their velocities do not, against the work of the explicit
  /// Coriolis force; and what guards take from the velocity.
  Eigen::Vector3d integrator = Eigen::Vector3d::Zero();
};

/// Linear momentum of all bodies at kin's velocities, g cm/s.
Eigen::Vector3d linear_momentum(const Model& model, const Kinematics& kin);

/// Opens the ledger at a moment.
MomentumLedger open_momentum(const Model& model, const Moment& now);

/// Books the step `in` from where the ledger stands, by its solution at `place`, to `next`.
void book_momentum(const StepInput& in, const StepPlace& place, const StepSolution& step,
                   const Moment& next, MomentumLedger& ledger);

}  // namespace hagfish
