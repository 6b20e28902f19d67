// The energy ledger: where every erg comes from and goes to, so that no damping hides.
//
// Forces work over the displacement that the step makes: h u (Eq. 2), or t u of a step that ends
// early (simulation.hpp), with u = q̇ by Euler's rule. What the rule then gains or loses by itself
// is written down apart, from its own formulas and not as the remainder, so that
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
  double kinetic = 0, elastic = 0, gravity = 0;
  double work_tip = 0;
  double work_active = 0;  ///< of the muscles: of the active torque
  ByKind<double> work;     ///< of the constraint forces
  double dissipated = 0;   ///< by drag and joint damping
  /// Lost where bodies hit each other, a limit or what holds them, or are stopped or started by Eq.
  /// 6 at once. Midpoint: (u - x)'M Δv, as u is x but for impacts. Euler's rule knows all forces of
  /// rows over whole steps: Σ ½ λ C Δv of the rows, but those of Eq. 6, that come to a stop or part
  /// (Carnot).
  double impacts = 0;
  /// (y - (t/h) u)' M Δv with the mean y of the velocities before and after, less what impacts
  /// lose: by Euler's rule -½ Δv' M Δv, what its steps lose when velocities change; and the share
  /// of the impulse that has no displacement to work over.
  double integrator_inertia = 0;
  /// Of the implicit springs and their numerical damping, t u' K (½ t u - r x - β (2 x - v))
  /// (energy.cpp), and gravity over the curved path.
  double integrator_potential = 0;
  /// Change of M along the step against the work of the Coriolis force: by the midpoint rule, what
  /// its passes leave (BiasPower).
  double integrator_coriolis = 0;
  /// Taken back from the velocity where the scene holds the integrator's gain (guard.hpp), <= 0.
  double integrator_held = 0;
  /// By what momentum a free body is given back (momentum.hpp).
  double integrator_momentum = 0;
  double lowest_error = 0;  ///< of integrator_error() so far
  double largest = 0;       ///< kinetic + elastic so far

  double works() const {
    return std::accumulate(work.of_kind.begin(), work.of_kind.end(), work_tip + work_active);
  }
  double integrator_error() const {
    return integrator_inertia + integrator_potential + integrator_coriolis + integrator_held +
           integrator_momentum;
  }
  /// What the ledger fails to explain, erg.
  double imbalance() const {
    return kinetic + elastic + gravity - initial - works() + dissipated + impacts -
           integrator_error();
  }
};

/// Opens the ledger at a moment.
EnergyLedger open_ledger(const Model& model, const Moment& now);

/// Books the step `in` from where the ledger stands, by its solution at `place`, to `next`, where
/// it has led in the time `travelled` (s), 0 to h.
void book_step(const StepInput& in, const StepPlace& place, const StepSolution& step,
               const Moment& next, double travelled, EnergyLedger& ledger);

}  // namespace hagfish
