// How a step or a run ended, by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace hagfish {

enum class Outcome : std::uint8_t {
  ok,
  non_finite,      ///< a position or velocity is not finite
  penetration,     ///< skins overlap by more than the scene permits
  limits,          ///< a joint is past its limit by more than the scene permits
  speed,           ///< a body is faster than the scene permits
  energy_gain,     ///< the integrator made more energy than the scene permits
  infeasible,      ///< rows contradict each other
  solver_failed,   ///< the back end failed, or its answer is not accurate enough
  never_tied,      ///< the script ended without the knot
  knot_lost,       ///< the knot changed its type before its release
  capped,          ///< not done in time, or thigmotaxis rows stayed at controller.cap
  tunnelled,       ///< strands passed through each other: they overlapped by more than a radius
  stopped,         ///< stopped on request, or after its time limit
  not_applicable,  ///< the scene needs something that this simulator does not have
  overbent,        ///< a curvature program bends a joint past its limits
  saturated,       ///< muscles are at their capacity
  unsettled,       ///< the passes of a step did not converge
  momentum_gain,   ///< the integrator pushed or turned a free body more than permitted
};
/// Names in the order of the enumeration.
inline constexpr std::array outcome_names = {
    "ok",         "non-finite",     "penetration", "limits",    "speed",     "energy gain",
    "infeasible", "solver failed",  "never tied",  "knot lost", "capped",    "tunnelled",
    "stopped",    "not applicable", "overbent",    "saturated", "unsettled", "momentum gain"};
static_assert(outcome_names.size() == static_cast<std::size_t>(Outcome::momentum_gain) + 1);

inline const char* outcome_name(Outcome outcome) {
  return outcome_names[static_cast<std::size_t>(outcome)];
}

/// How a step or a run ended.
struct [[nodiscard]] Status {
  Outcome outcome = Outcome::ok;
  /// One line with the amount, the bodies or rows involved, and the setting that would help. Empty
  /// where ok.
  std::string message;
  bool ok() const { return outcome == Outcome::ok; }
};

/// A step that cannot be taken; what() is the message of its status.
class StepError : public std::runtime_error {
 public:
  explicit StepError(const Status& status)
      : std::runtime_error(status.message), outcome_(status.outcome) {}
  Outcome outcome() const { return outcome_; }

 private:
  Outcome outcome_;
};

}  // namespace hagfish
