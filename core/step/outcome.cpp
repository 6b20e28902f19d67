#include "core/step/outcome.hpp"

#include <array>

namespace hagfish {

const char* outcome_name(Outcome outcome) {
  constexpr std::array<const char*, outcome_count> names = {
      "ok",         "non-finite",     "penetration", "limits",    "speed",     "energy gain",
      "infeasible", "solver failed",  "never tied",  "knot lost", "capped",    "tunnelled",
      "stopped",    "not applicable", "overbent",    "saturated", "unsettled", "momentum gain"};
  return names[static_cast<std::size_t>(outcome)];
}

}  // namespace hagfish
