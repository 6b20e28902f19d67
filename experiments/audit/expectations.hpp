// Figures of a run against the bounds of its scene's [expect]: the one place where they meet, for
// `hagfish check` and for the failure map.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/settings.hpp"

namespace hagfish {

/// A figure and the bound on it.
struct Criterion {
  std::string name;  ///< what is judged, in a word or two
  double value = 0;  ///< nan where the run has no such figure
  double bound = 0;
  std::string unit;
  bool at_least = false;  ///< the bound is the least, not the most
  /// Never of a figure that is no number.
  bool met() const { return at_least ? value >= bound : value <= bound; }
};

/// Deepest overlap of skins at any step, cm.
Criterion penetration_criterion(const ExpectSettings& expect, double deepest);
/// Furthest that a joint is past its limit at any step, rad; judged in degrees.
Criterion limits_criterion(const ExpectSettings& expect, double furthest);
/// Largest way of the clamped head at any step, cm.
Criterion head_drift_criterion(const ExpectSettings& expect, double largest);
/// Largest scaled KKT residual of any step.
Criterion kkt_criterion(const ExpectSettings& expect, double largest);
/// As EnergyGain has it.
Criterion energy_gain_criterion(const ExpectSettings& expect, double largest);
/// As IntegratorLoss has it, of the most energy that there was, worked or went to drag and damping.
Criterion energy_loss_criterion(const ExpectSettings& expect, double largest);
/// Headward travel of the knot's head end while sliding, cm; nothing where it never slid.
Criterion slide_criterion(const ExpectSettings& expect, std::optional<double> travel);
/// Tailward travel of its tail end on the way back, cm; likewise.
Criterion reverse_criterion(const ExpectSettings& expect, std::optional<double> travel);
/// Mean pull at the food, dyn; judged in N.
Criterion pull_criterion(const ExpectSettings& expect, double mean);
/// Mean of the later half of the pull less that of the earlier one, dyn, of their mean.
Criterion pull_drift_criterion(const ExpectSettings& expect, double earlier, double later);
/// Mean force of the head plate less the mean pull, of the latter, both in dyn.
Criterion pull_balance_criterion(const ExpectSettings& expect, double plate, double pull);
/// Sliding steps that meet Eq. 6 without slack, of all sliding steps; judged in %.
Criterion eq6_criterion(const ExpectSettings& expect, std::int64_t met, std::int64_t steps);

/// The larger; a figure that is no number is as bad as can be.
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? INFINITY : std::max(a, b);
}

/// Mechanical energy (kinetic, elastic, gravity) above what there was and what script and
/// thigmotaxis put in, over the most that there was of these so far.
class EnergyGain {
 public:
  /// `energy` at the start, erg.
  explicit EnergyGain(double energy) : start_(energy), most_(energy) {}
  /// A later moment: `energy`, and what was put in since the start, erg.
  void see(double energy, double put_in);
  double largest() const { return largest_; }

 private:
  double start_ = 0, most_ = 0, largest_ = 0;
};

/// What the integrator takes: how far the sum of its own terms falls below what it was before.
class IntegratorLoss {
 public:
  /// The sum at a later moment, erg.
  void see(double error) {
    highest_ = std::max(highest_, error);
    largest_ = worse(largest_, highest_ - error);
  }
  double largest() const { return largest_; }
  /// Of sums from the start on.
  template <class Errors>
  static double of(const Errors& errors) {
    IntegratorLoss loss;
    for (const double error : errors) loss.see(error);
    return loss.largest();
  }

 private:
  double highest_ = -INFINITY, largest_ = 0;
};

}  // namespace hagfish
