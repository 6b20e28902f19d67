// A step that cannot be taken, with its cause by name.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hagfish {

/// Why a run stopped.
enum class StopCause : std::uint8_t {
  non_finite,     ///< a position or velocity is no number any more
  penetration,    ///< skins overlap, or passed through each other, by more than the scene permits
  limits,         ///< a joint is past its limit by more than the scene permits
  speed,          ///< a body is faster than the scene permits
  energy_gain,    ///< the integrator made more energy than the scene permits
  infeasible,     ///< rows contradict each other
  solver_failed,  ///< the back end gave up
  never_tied,     ///< the script ended without the knot
  knot_lost,      ///< the knot changed its type while it should have held
  capped          ///< a thigmotaxis row stays at its cap; warns only
};
inline constexpr int stop_cause_count = 10;
/// "non-finite", "energy gain", ...
const char* stop_cause_name(StopCause cause);

/// what() tells all in one line: cause, amount, what took part, and the setting that would help.
class StepError : public std::runtime_error {
 public:
  StepError(StopCause cause, const std::string& message)
      : std::runtime_error(message), cause_(cause) {}
  StopCause cause() const { return cause_; }

 private:
  StopCause cause_;
};

}  // namespace hagfish
