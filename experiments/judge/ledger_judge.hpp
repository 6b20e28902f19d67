// What the ledgers of energy and momentum say of a run: whether they close, what the integrator
// made or took, and that nothing from outside moved a free animal.
#pragma once

#include <vector>

#include "experiments/judge/expectations.hpp"
#include "experiments/judge/run_frame.hpp"

namespace hagfish {

/// One of the two ledgers of momentum, linear or angular.
class MomentumWatch {
 public:
  explicit MomentumWatch(Eigen::Vector3d Momentum::*part) : part_(part) {}
  /// `held`, `free`: the head is at this frame and the one before, or at neither.
  void see(const MomentumLedger& ledger, bool held, bool free);

  /// The imbalance as a share of what passed: `through` the sum of the sizes of forces from
  /// outside, `largest_total` of what the parts of the body may have.
  double off(double through, double largest_total) const;
  Finding ledger(const char* name, const char* unit, const ExpectSettings& expect, double through,
                 double largest_total) const;
  /// What the integrator makes, and does not give back, from frames to frames at which nothing
  /// holds the head; of `scale` or what drag took.
  double made_while_free(double scale, double largest_total) const;
  bool given_while_held() const { return given_while_held_; }
  double outside() const { return outside_; }

 private:
  Eigen::Vector3d Momentum::*part_;
  bool any_ = false, given_while_held_ = false;
  MomentumLedger first_, before_;
  Eigen::Vector3d made_so_far_ = Eigen::Vector3d::Zero();
  /// Largest entries: of the momentum; of the others since the first frame.
  double momentum_ = 0, drag_ = 0, outside_ = 0, integrator_ = 0, given_back_ = 0;
  double off_ = 0, made_ = 0;
  double total_ = 0;  ///< largest of any running total
};

/// Watches both ledgers, frame by frame. Totals count since the first frame: a branch goes on with
/// those of its run.
class LedgerJudge {
 public:
  LedgerJudge(const Model& model, const Scene& scene);
  void see(const RunFrame& frame);

  double energy_off() const;   ///< imbalance of the ledger, of the energy that passed
  double energy_loss() const;  ///< loss of ExpectSettings::energy_loss
  double energy_gain() const { return gain_.largest(); }
  double momentum_off() const;  ///< imbalance of linear momentum, of the momentum that passed
  std::vector<Finding> findings() const;

 private:
  std::vector<Finding> momentum() const;
  double largest_energy() const { return std::max(largest_energy_, passed_.energy()); }
  /// Momentum that the parts of the body have while all of it has none, and while it falls.
  double parts() const;
  double all() const;

  const Model& model_;
  const Scene& scene_;
  Passed passed_;
  bool any_ = false, ever_free_ = false, clamped_before_ = false;
  double time_before_ = 0;
  Eigen::Vector3d tip_before_ = Eigen::Vector3d::Zero();
  EnergyLedger first_, last_;
  EnergyGain gain_{0};
  IntegratorLoss loss_;
  double off_ = 0, passed_energy_ = 0, had_ = 0, largest_energy_ = 0, kinetic_ = 0, parts_ = 0;
  MomentumWatch linear_{&Momentum::linear}, angular_{&Momentum::angular};
};

}  // namespace hagfish
