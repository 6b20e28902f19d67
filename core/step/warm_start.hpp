// Start values that a step leaves for the next one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/step/rows/row.hpp"

namespace hagfish {

/// Multipliers of the last step by row id.
class WarmStart {
 public:
  struct Kept {
    RowId id;
    double lambda = 0;  ///< dyn s or dyn cm s
  };
  /// Restores the initial values, but keeps the storage.
  void forget();
  /// Forgets the multipliers.
  void begin() { entries_.clear(); }
  /// Ids may come in any order, once each. Call end() before any look-up.
  void add(const RowId& id, double lambda) { entries_.push_back({id, lambda}); }
  void end();
  /// The entry of a row, or null.
  const Kept* find(const RowId& id) const;
  /// The multiplier of a row, 0 where there is none.
  double multiplier(const RowId& id) const;
  std::size_t size() const { return entries_.size(); }
  /// Half of the change of velocity by steady forces, in the last step and in the one before it,
  /// nv. The midpoint rule extrapolates them to the middle of the next step. Empty where there was
  /// none.
  Eigen::VectorXd half_change, half_before;
  double remaining = 1;  ///< StepMiddle::remaining of the last step

 private:
  std::vector<Kept> entries_;  // sorted by id
};

}  // namespace hagfish
