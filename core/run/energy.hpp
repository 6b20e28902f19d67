// The energy ledger: sources and losses of all energy, so that no numerical damping stays hidden.
//
// Forces work over the displacement of the step, h u (Eq. 2), or t u in a step that ends early
// (simulation.hpp). By Euler's rule u = q̇. The gain or loss of the rule itself is computed from
// its own formulas and not as the remainder. So
//   kinetic + elastic + gravity - initial = works - dissipated - impacts + integrator error
// is a check: it closes to rounding, or the step is not what it claims.
#pragma once

#include <numeric>

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// Energies in erg. Works, dissipated and integrator terms are running totals.
struct EnergyLedger {
  double initial = 0;  ///< kinetic + elastic + gravity at the start
  double kinetic = 0, gravity = 0;
  double elastic = 0;  ///< energy in joint springs and flesh
  double work_tip = 0;
  double work_active = 0;  ///< work of the active torque of the muscles
  ByKind<double> work;     ///< work of the constraint forces, without those of flesh
  double dissipated = 0;   ///< loss by drag, joint damping and damping of flesh
  /// Energy lost where bodies hit each other, a limit or a clamp, or where Eq. 6 stops or starts
  /// them at once. Midpoint rule: (u - x)'M Δv, since u = x without impacts. Euler's rule knows the
  /// forces of rows over whole steps only: Σ ½ λ C Δv of the rows, except those of Eq. 6, that come
  /// to a stop or part (Carnot).
  double impacts = 0;
  /// (y - (t/h) u)' M Δv with the mean y of the velocities before and after, less the loss by
  /// impacts. By Euler's rule this is -½ Δv' M Δv, its loss when velocities change, and the share
  /// of the impulse that has no displacement to work over.
  double integrator_inertia = 0;
  /// Gain by the implicit springs and their numerical damping, t u' K (½ t u - r x - β (2 x - v))
  /// (energy.cpp), by gravity over the curved path, and by flesh, whose points change along it.
  double integrator_potential = 0;
  /// Change of M along the step against the work of the Coriolis force. By the midpoint rule, what
  /// its passes leave (BiasPower).
  double integrator_coriolis = 0;
  /// Energy taken back from the velocity where the scene bounds the integrator's gain (guard.hpp),
  /// <= 0.
  double integrator_held = 0;
  /// Energy change by the correction of a free body's momentum (momentum.hpp).
  double integrator_momentum = 0;
  /// Part of integrator_error() that the translation of the centre of mass has, while momentum is
  /// kept (step_input.hpp) and no obstacle bears. It depends on the observer.
  double integrator_translation = 0;
  double lowest_error = 0;  ///< lowest own_error() so far
  /// Largest kinetic + elastic so far; while momentum is kept, about the centre of mass.
  double largest = 0;

  double works() const {
    return std::accumulate(work.of_kind.begin(), work.of_kind.end(), work_tip + work_active);
  }
  double integrator_error() const {
    return integrator_inertia + integrator_potential + integrator_coriolis + integrator_held +
           integrator_momentum;
  }
  /// integrator_error() as one sees it who moves with a free body.
  double own_error() const { return integrator_error() - integrator_translation; }
  /// The energy that the ledger does not explain, erg.
  double imbalance() const {
    return kinetic + elastic + gravity - initial - works() + dissipated + impacts -
           integrator_error();
  }
};

/// Opens the ledger at a moment; `kept`: momentum is (step_input.hpp).
EnergyLedger open_ledger(const Model& model, const ObservedState& now, bool kept);

/// Books the step `in` from the ledger's last entry, by its solution at `place`, to `next`, the
/// state after the time `travelled` (s), 0 to h.
void book_step(const StepInput& in, const StepPlace& place, const StepSolution& step,
               const ObservedState& next, double travelled, EnergyLedger& ledger);

}  // namespace hagfish
