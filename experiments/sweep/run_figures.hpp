// What a run comes to, from its steps as they are taken, without a log: the figures of `hagfish
// export`'s summary and those that `hagfish check` holds against the scene's [expect], at the same
// steps and frames. A test compares them with both.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/log/log_means.hpp"
#include "core/run/simulation.hpp"
#include "experiments/audit/audit_knot.hpp"
#include "experiments/audit/audit_pull.hpp"
#include "experiments/audit/expectations.hpp"

namespace hagfish {

/// Figures of one run; nan where it has none.
struct RunSummary {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::string outcome;     ///< "ok" of a run that came to its end, else as outcome_name has it
  std::string unmet;       ///< criteria of [expect] that it does not meet, joined by "; "
  std::string message;     ///< why it stopped
  std::string knot;        ///< type as it first must hold, or at the end
  double duration = none;  // s
  double tighten_from = none, slide_from = none, release_from = none, free_from = none;  // s
  double slide_distance = none, slide_speed = none;                                      // cm, cm/s
  /// Slide::trailing_way, taper_asks, travel, cm; correlation; 100 share(), %; slide_name().
  double tail_distance = none, taper_asks = none, curvature_travel = none;
  double curvature_correlation = none, both_ends = none;
  std::string slide;
  double sliding_force = none;                                                      // dyn
  double largest_thigmotaxis = none, largest_active = none, largest_torque = none;  // dyn cm
  double pull = none;                                                               // N
  double penetration = none, limit_violation = none;                                // cm, rad
  double skin_fold = none;                                                          // 1
  double head_drift = none, kkt = none;                                             // cm, 1
  double eq6 = none;                                                                // %
  double energy_ledger = none, energy_gain = none, energy_loss = none, momentum_ledger = none;  // 1
  double work_tip = none, work_active = none, work_thigmotaxis = none, dissipated = none;  // erg

  /// Headings, with units, and fields: numbers are the shortest that read back as the same double.
  std::vector<std::pair<std::string, std::string>> fields() const;
};

/// Watches a run step by step.
class RunFigures {
 public:
  /// Both are referred to.
  RunFigures(const Model& model, const Scene& scene);
  /// Each step, in order, from step 0.
  void see(const StepRecord& record);
  /// The run has ended as `sim`: no step follows.
  void see_end(const Simulation& sim);
  /// How the run ended: "ok" or the outcome by name, and why.
  RunSummary summary(const std::string& outcome, const std::string& message) const;

 private:
  /// A frame of the log that there could be.
  struct Seen {
    double time = 0;  // s
    Phase phase = Phase::form;
    double rows = 0;             // sum of the four mean λ / h, dyn
    double pull = 0, plate = 0;  // means, dyn
  };
  struct Stretch {
    std::size_t first = 0, last = 0;  // indices along the frames
    bool reached = false;
  };

  void see_frame(const StepRecord& record);
  void see_ledgers(const StepRecord& record);
  Stretch stretch(Phase phase) const;
  bool reaches(Phase phase) const;
  std::vector<Criterion> criteria(const RunSummary& run) const;
  std::vector<PullMeans> pull() const;
  std::string type_at_end() const;
  std::vector<std::string> unmet(const RunSummary& run) const;

  const Model& model_;
  const Scene& scene_;
  RunningMeans means_;
  std::int64_t stride_;     // steps a frame
  std::int64_t steps_ = 0;  // seen
  std::vector<Seen> frames_;
  SlideWatch slides_;
  std::string held_;                  // type at the first frame at which it must hold
  Eigen::Matrix3Xd last_centreline_;  // at the last frame
  bool lost_ = false, clamped_ = false, ended_ = false;
  double penetration_ = 0, skin_fold_ = 0, limit_violation_ = 0, head_drift_ = 0, kkt_ = 0;
  double largest_thigmotaxis_ = 0, largest_active_ = 0, largest_torque_ = 0;
  std::int64_t eq6_met_ = 0, eq6_steps_ = 0;              // of slides, up to the last frame
  std::int64_t eq6_met_since_ = 0, eq6_steps_since_ = 0;  // and since
  Passed passed_;
  double largest_energy_ = 0, largest_momentum_ = 0;  // of any total
  double first_balance_ = 0, imbalance_ = 0, worked_ = 0, dissipated_ = 0;
  Eigen::Vector3d first_momentum_ = Eigen::Vector3d::Zero();
  double momentum_off_ = 0, momentum_passed_ = 0;
  IntegratorLoss loss_;
  double first_error_ = 0, had_ = 0;
  EnergyGain gain_{0};
  EnergyLedger ledger_;
};

}  // namespace hagfish
