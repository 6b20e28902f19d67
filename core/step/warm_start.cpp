#include "core/step/warm_start.hpp"

#include <algorithm>

namespace hagfish {

void WarmStart::forget() {
  entries_.clear();
  half_change.resize(0);
  half_before.resize(0);
  remaining = 1;
}

void WarmStart::end() { std::ranges::sort(entries_, {}, &Kept::id); }

const WarmStart::Kept* WarmStart::find(const RowId& id) const {
  const auto it = std::ranges::lower_bound(entries_, id, {}, &Kept::id);
  return it == entries_.end() || it->id != id ? nullptr : &*it;
}

double WarmStart::multiplier(const RowId& id) const {
  const Kept* kept = find(id);
  return kept == nullptr ? 0 : kept->lambda;
}

}  // namespace hagfish
