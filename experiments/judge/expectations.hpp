// Figures of a run against the bounds of its scene's [expect]: the one place where they meet, for
// `hagfish check` and for the failure map.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/run/slide.hpp"
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

/// What was judged, in figures and in words. Figures are numbers, or words where it is those that
/// are compared; empty where the log has none.
struct Finding {
  std::string name;    ///< what was judged, in a word or two
  bool passed = true;  ///< false fails the log
  std::string text;    ///< the figure and its bound, in one line
  std::string value, bound, unit;
};

/// A finding on a figure, described by `text`.
Finding judged(const Criterion& criterion, const std::string& text);

/// A finding described as "VALUE UNIT, SCOPE (at most BOUND)".
Finding judged_over(const Criterion& criterion, const std::string& scope = "");

/// So many of so many: all must be, and there must be some.
Finding all_of(const std::string& name, std::int64_t count, std::int64_t of,
               const std::string& unit, const std::string& text);

/// Deepest overlap of skins at any step, cm; of flesh, which may overlap, against a bound of its
/// own.
Criterion penetration_criterion(const Scene& scene, double deepest);
/// Largest skin_fold() while the knot is held, 0 where it never is.
Criterion skin_fold_criterion(const ExpectSettings& expect, double largest);
/// Furthest that a joint is past its limit at any step, rad; judged in degrees.
Criterion limits_criterion(const ExpectSettings& expect, double furthest);
/// Largest way of the clamped head at any step, cm.
Criterion head_drift_criterion(const ExpectSettings& expect, double largest);
/// Largest scaled KKT residual of any step.
Criterion kkt_criterion(const ExpectSettings& expect, double largest);
/// Criterion of EnergyGain.
Criterion energy_gain_criterion(const ExpectSettings& expect, double largest);
/// Criterion of IntegratorLoss, of the most energy that there was, worked or went to drag and
/// damping.
Criterion energy_loss_criterion(const ExpectSettings& expect, double largest);
/// A slide against what the scene asks of it: the way of the knot's head end, cm, and the share by
/// which it is a slide of both ends, in %. The head end is asked for the scene's distance. If it
/// began nearer to where it is released, it is asked for all the way there, but for half of that
/// distance at least where the slide is seen `whole`.
std::vector<Criterion> slide_criteria(const Scene& scene, const Slide& slide, bool whole = true);
/// Criteria of the way back, by the tail end and wherever it began.
std::vector<Criterion> way_back_criteria(const Scene& scene, const Slide& way_back);
/// The phases of ExpectSettings::torque_share.
inline bool slides_or_pulls(Phase phase) { return phase == Phase::slide || phase == Phase::pull; }
/// Largest torque of a hinge in these phases, own and f_thigmo, mean from frame to frame, dyn cm.
Criterion torque_criterion(const Scene& scene, double largest);
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

/// What passes through the body: sums of the sizes of its weight, the tip's force, and those of
/// head clamp and obstacles. They do not vanish at rest, nor cancel where forces hold each other.
class Passed {
 public:
  /// Counts by a scene's model and its steps of `h` (s).
  Passed(const Model& model, double h);
  /// Means of generalised forces (nv) from one frame to the next, `elapsed` (s) later; dyn, dyn cm.
  void see(double elapsed, const Eigen::Vector3d& tip, const Eigen::VectorXd& head,
           const Eigen::VectorXd& obstacles);
  double momentum() const { return momentum_; }                 ///< dyn s
  double angular_momentum() const { return arm_ * momentum_; }  ///< a straight body's, dyn cm s
  /// Most that these forces would give the body in one step, erg.
  double energy() const { return 0.5 * step_momentum_ * step_momentum_ / mass_; }
  double mass() const { return mass_; }
  /// Radius of gyration of a straight body, cm.
  double arm() const { return arm_; }

 private:
  double mass_, weight_, arm_, h_;
  double momentum_ = 0, step_momentum_ = 0;
};

/// Sums of all steps are known to this share of the largest of them: some thousand additions round.
inline constexpr double totals_rounding = 1e-12;

/// A difference of totals as a share of `scale`: 0 where the difference is no more than what
/// rounding leaves of totals up to `largest_total`.
inline double share_of(double off, double scale, double largest_total) {
  if (std::isfinite(off) && off <= totals_rounding * largest_total) return 0;
  return scale > 0 ? off / scale : off;
}

/// Mechanical energy (kinetic, elastic, gravity) above what there was and what script and
/// thigmotaxis put in, over the most kinetic and elastic energy that there could be so far.
class EnergyGain {
 public:
  /// `energy` at the start, of it in gravity, erg.
  explicit EnergyGain(double energy, double gravity = 0)
      : start_(energy), most_(energy - gravity) {}
  /// A later moment: `energy`, what was put in since the start, and the energy in gravity, erg.
  void see(double energy, double put_in, double gravity = 0);
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
  /// Loss by sums from the start on.
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
