// How a step or a run ended, by name.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hagfish {

enum class Outcome : std::uint8_t {
  ok,
  non_finite,     ///< a position or velocity is not finite
  penetration,    ///< skins overlap by more than the scene permits
  limits,         ///< a joint is past its limit by more than the scene permits
  speed,          ///< a body is faster than the scene permits
  energy_gain,    ///< the integrator made more energy than the scene permits
  infeasible,     ///< rows contradict each other
  solver_failed,  ///< the back end failed, or its answer is not accurate enough
  never_tied,     ///< the script ended without the knot
  knot_lost,      ///< the knot changed its type before its release
  capped,         ///< not done in time, or thigmotaxis rows stayed at controller.cap
  tunnelled,      ///< strands passed through each other: deeper at or between steps than any radius
  stopped,        ///< it was asked to, or took longer than it may
  not_applicable,  ///< the scene needs what the simulator in question does not have
  overbent,        ///< a curvature program bends a joint further than it goes
  saturated,       ///< muscles make all the torque that they can
  unsettled,       ///< the middle of a step is not known well enough
  momentum_gain,   ///< it pushed or turned a free body by more than the scene permits
};
inline constexpr int outcome_count = 18;
/// "ok", "non-finite", "energy gain", ...
const char* outcome_name(Outcome outcome);

/// What became of a step or a run.
struct [[nodiscard]] Status {
  Outcome outcome = Outcome::ok;
  /// One line that tells all: amount, what took part, and the setting that would help. Empty where
  /// ok.
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
