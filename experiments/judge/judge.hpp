// What a run comes to, and how that stands against its scene's [expect]: the one place, for
// `check`, `sweep`, `sure`, `design` and the summary of `export`.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/judge/figure_unit.hpp"
#include "experiments/judge/knot_judge.hpp"
#include "experiments/judge/ledger_judge.hpp"
#include "experiments/judge/pull_judge.hpp"

namespace hagfish {

/// Figures of one run; nan where it has none. run_figures() says what each is.
struct RunSummary {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::string outcome;  ///< "ok" of a run that came to its end, else as outcome_name has it
  std::string unmet;    ///< criteria of [expect] that it does not meet, joined by "; "
  std::string message;  ///< why it stopped
  std::string knot, slide;
  double duration = none, tighten_from = none, slide_from = none, release_from = none,
         free_from = none, slide_distance = none, slide_speed = none, tail_distance = none,
         taper_asks = none, curvature_travel = none, curvature_correlation = none, both_ends = none,
         sliding_force = none, largest_thigmotaxis = none, largest_active = none,
         largest_torque = none, pull = none, penetration = none, skin_fold = none,
         limit_violation = none, head_drift = none, kkt = none, eq6 = none, energy_ledger = none,
         energy_gain = none, energy_loss = none, momentum_ledger = none, work_tip = none,
         work_active = none, work_thigmotaxis = none, dissipated = none;

  /// Headings, with units, and fields: outcome, unmet, message and figures. Numbers are the
  /// shortest that read back as the same double.
  std::vector<std::pair<std::string, std::string>> fields() const;
};

struct RunFigure {
  const char* name;  ///< without its unit
  FigureUnit unit;
  const char* meaning;
  std::variant<double RunSummary::*, std::string RunSummary::*> value;
};
/// All figures of a RunSummary, in the order of tables.
std::span<const RunFigure> run_figures();

/// Judges a run, frame by frame and step by step.
class Judge {
 public:
  /// Both are referred to. A branch begins later than its run, of which it shows a part.
  Judge(const Model& model, const Scene& scene, bool branch = false);
  /// The frame before the steps that begin at it.
  void see(const RunFrame& frame);
  void see(const RunStep& step);
  /// Worst figures of moments that are not those of steps.
  void see(const Worst& worst);

  /// How the run ended: "ok" or the outcome by name, and why.
  RunSummary summary(const std::string& outcome, const std::string& message) const;
  /// All that [expect] asks, of a run with a frame or more.
  std::vector<Finding> findings() const;
  /// What of this is of the motion and its torques, whichever simulator made them: the knot and its
  /// slide, overlap, limits, the clamped head, the skin.
  std::vector<Finding> of_motion() const;

 private:
  std::optional<Finding> eq6() const;

  const Model& model_;
  const Scene& scene_;
  KnotJudge knot_;
  LedgerJudge ledgers_;
  PullJudge pull_;
  std::int64_t steps_ = 0;
  bool any_ = false;
  double first_time_ = 0, last_time_ = 0;
  Phase phase_ = Phase::form;  ///< phase of the last frame
  EnergyLedger ledger_;        ///< ledger at the last frame
  std::vector<double> rows_;   ///< RunFrame::rows of frames of the slide
  Worst worst_;
  double largest_thigmotaxis_ = 0, largest_active_ = 0, largest_torque_ = 0;
  std::int64_t met_ = 0, sliding_ = 0;              // counts of slides' steps, up to the last frame
  std::int64_t met_since_ = 0, sliding_since_ = 0;  // and since
};

}  // namespace hagfish
