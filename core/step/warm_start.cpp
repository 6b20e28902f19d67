#include "core/step/warm_start.hpp"

#include <algorithm>
#include <utility>

namespace hagfish {

void WarmStart::forget() {
  entries_.clear();
  before_.clear();
  half_change.resize(0);
  half_before.resize(0);
  remaining = 1;
}

void WarmStart::begin() {
  std::swap(entries_, before_);
  entries_.clear();
}

void WarmStart::end() {
  std::ranges::sort(entries_, {}, &Kept::id);
  auto old = before_.begin();
  for (Kept& kept : entries_) {
    while (old != before_.end() && old->id < kept.id) {
      ++old;
    }
    if (old != before_.end() && old->id == kept.id) {
      kept.change = kept.lambda - old->lambda;
    }
  }
}

const WarmStart::Kept* WarmStart::find(std::int64_t id) const {
  const auto it = std::ranges::lower_bound(entries_, id, {}, &Kept::id);
  return it == entries_.end() || it->id != id ? nullptr : &*it;
}

double WarmStart::multiplier(std::int64_t id) const {
  const Kept* kept = find(id);
  return kept == nullptr ? 0 : kept->lambda;
}

}  // namespace hagfish
