// What energy is lost to, as logs call it.
#pragma once

#include "core/run/energy.hpp"

namespace hagfish {

struct EnergyLoss {
  const char* name;
  const char* description;
  double EnergyLedger::*member;  ///< so far, erg
};

inline constexpr EnergyLoss energy_losses[] = {
    {"dissipated", "lost to drag and joint damping so far", &EnergyLedger::dissipated},
    {"impact_loss", "lost where bodies hit each other, a limit or what holds them, so far",
     &EnergyLedger::impacts}};

}  // namespace hagfish
