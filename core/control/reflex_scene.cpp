// The reasons why a scene cannot have the reflex.
#include <cmath>
#include <string>
#include <utility>

#include "core/control/reflex.hpp"

namespace hagfish {

std::optional<SceneFault> reflex_fault(const Specimen& specimen, const Scene& scene) {
  const ReflexSettings& reflex = scene.controller.reflex;
  const std::string table = "controller.reflex.";
  const std::string where = " where controller.law = \"" + scene.controller.law + "\"";
  if (reflex.shift == 0) return SceneFault{table + "shift", "must not be 0" + where};
  for (const auto& [key, value] :
       {std::pair("shift", reflex.shift), {"pull_shift", reflex.pull_shift}}) {
    if (std::abs(value) >= specimen.length) {
      return SceneFault{table + key, "must be less than the animal's length"};
    }
  }
  if (!reflex.bend_y && !reflex.bend_z && !reflex.twist) {
    return SceneFault{table + "bend_y", "must be true, or bend_z or twist must be true"};
  }
  if (reflex.gate == ReflexGate::touch && reflex.reach == 0) {
    return SceneFault{table + "reach", "must be positive where gate = \"touch\""};
  }
  if (reflex.gate == ReflexGate::touch && scene.contact.least_arc >= specimen.length) {
    return SceneFault{table + "gate", "the body never touches itself (contact.least_arc)"};
  }
  if (reflex.delay > 0 && reflex.delay < scene.time.step) {
    return SceneFault{table + "delay", "must not be less than time.step"};
  }
  constexpr int most_lag = 10000;  // largest delay, in steps
  if (reflex.delay > most_lag * scene.time.step) {
    return SceneFault{table + "delay",
                      "must be at most " + std::to_string(most_lag) + " times time.step"};
  }
  for (const auto& [key, value] : {std::pair("active.stiffness", scene.active.stiffness),
                                   {"active.relax_time", scene.active.relax_time},
                                   {"active.capacity", scene.active.capacity}}) {
    if (value == 0) return SceneFault{key, "must be positive" + where};
  }
  return {};
}

}  // namespace hagfish
