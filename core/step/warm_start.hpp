// Start values that a step leaves for the next one.
#pragma once

#include <Eigen/Core>
#include <algorithm>
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
  void forget() {
    entries_.clear();
    half_change.resize(0);
    half_before.resize(0);
    remaining = 1;
  }
  /// Forgets the multipliers.
  void begin() { entries_.clear(); }
  /// Ids may come in any order, once each. Call end() before any look-up.
  void add(const RowId& id, double lambda) { entries_.push_back({id, lambda}); }
  void end() { std::ranges::sort(entries_, {}, &Kept::id); }
  /// The entry of a row, or null.
  const Kept* find(const RowId& id) const {
    const auto it = std::ranges::lower_bound(entries_, id, {}, &Kept::id);
    return it == entries_.end() || it->id != id ? nullptr : &*it;
  }
  /// The multiplier of a row, 0 where there is none.
  double multiplier(const RowId& id) const {
    const Kept* kept = find(id);
    return kept == nullptr ? 0 : kept->lambda;
  }
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
