// What logs call the entries of the ledgers of energy and momentum: who writes a log and who reads
// one back goes through the same list.
#pragma once

#include <string>

#include "core/run/energy.hpp"
#include "core/run/momentum.hpp"

namespace hagfish {

struct EnergyColumn {
  const char* name;  ///< name below /diagnostics
  const char* description;
  double EnergyLedger::*member;  ///< erg
};

inline constexpr EnergyColumn energy_sources[] = {
    {"kinetic_energy", "kinetic energy", &EnergyLedger::kinetic},
    {"elastic_energy", "energy in the joint springs and in flesh", &EnergyLedger::elastic},
    {"gravity_energy", "potential energy, 0 at the world's origin", &EnergyLedger::gravity},
    {"work_tip", "work of the scripted force so far", &EnergyLedger::work_tip},
    {"work_active", "work of the active torque so far", &EnergyLedger::work_active}};

/// What energy is lost to.
inline constexpr EnergyColumn energy_losses[] = {
    {"dissipated", "lost to drag, joint damping and damping of flesh so far",
     &EnergyLedger::dissipated},
    {"impact_loss", "lost where bodies hit each other, a limit or what holds them, so far",
     &EnergyLedger::impacts}};

/// Terms of integrator_error(), which is their sum.
inline constexpr EnergyColumn integrator_terms[] = {
    {"integrator_inertia",
     "gained by the integrator from velocity changes, without impacts, so far",
     &EnergyLedger::integrator_inertia},
    {"integrator_potential",
     "gained by the integrator from springs, their numerical damping and gravity so far",
     &EnergyLedger::integrator_potential},
    {"integrator_coriolis", "gained by the integrator from explicit Coriolis forces so far",
     &EnergyLedger::integrator_coriolis},
    {"integrator_held", "taken back from the velocity so far: what the integrator gained too much",
     &EnergyLedger::integrator_held},
    {"integrator_given_back",
     "gained so far as momentum that the integrator made is given back (momentum_given_back)",
     &EnergyLedger::integrator_momentum}};

/// Calls visit(name, description, of) for each, in the order of logs; of(ledger) refers to it.
template <class Visit>
void visit_energies(const Visit& visit) {
  const auto visit_all = [&visit](const auto& columns) {
    for (const EnergyColumn& column : columns) {
      visit(
          std::string(column.name),
          std::string(column.description), [member = column.member](auto& ledger) -> auto& {
            return ledger.*member;
          });
    }
  };
  visit_all(energy_sources);
  for (const RowKindEntry& force : row_kind_table) {
    visit(
        std::string("work_") + force.name, "work so far of: " + std::string(force.description),
        [kind = force.value](auto& ledger) -> auto& { return ledger.work[kind]; });
  }
  visit_all(energy_losses);
  visit_all(integrator_terms);
}

/// "impulse so far of tip, ... and gravity".
inline std::string outside_description() {
  std::string text = "impulse so far of tip, ";
  for (const RowKindEntry& force : row_kind_table) {
    if (force.from_outside) text += std::string(force.description) + ", ";
  }
  return text.replace(text.rfind(", "), 2, " and gravity");
}

struct MomentumColumn {
  const char* linear;   ///< name below /diagnostics
  const char* angular;  ///< name of the same about the centre of mass
  const char* unit;
  const char* angular_unit;
  std::string description;
  Momentum MomentumLedger::*member;
};

inline const MomentumColumn momentum_columns[] = {
    {"momentum", "angular_momentum", "g cm/s", "g cm²/s", "momentum of all bodies",
     &MomentumLedger::momentum},
    {"impulse_drag", "angular_impulse_drag", "dyn s", "dyn cm s", "impulse of drag so far",
     &MomentumLedger::drag},
    {"impulse_outside", "angular_impulse_outside", "dyn s", "dyn cm s", outside_description(),
     &MomentumLedger::outside},
    {"integrator_momentum", "integrator_angular_momentum", "g cm/s", "g cm²/s",
     "gained by the rule of the steps itself so far, before it is given back",
     &MomentumLedger::integrator},
    {"momentum_given_back", "angular_momentum_given_back", "g cm/s", "g cm²/s",
     "given back so far, after steps in which nothing held the head: what such a step gained "
     "itself, so that no motion of a free animal is the integrator's",
     &MomentumLedger::given_back}};

}  // namespace hagfish
