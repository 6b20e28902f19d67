#include "core/step/step_error.hpp"

namespace hagfish {

const char* stop_cause_name(StopCause cause) {
  constexpr const char* names[stop_cause_count] = {
      "non-finite", "penetration",   "limits",     "speed",     "energy gain",
      "infeasible", "solver failed", "never tied", "knot lost", "capped"};
  return names[static_cast<int>(cause)];
}

}  // namespace hagfish
