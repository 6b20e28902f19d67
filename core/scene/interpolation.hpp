// Linear interpolation in a table: values at rising knots, constant outside of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace hagfish {

/// A number's place among knots: the last one at or before it, and the share of the way to the
/// next; share 0 outside, at the first or the last knot.
struct TablePlace {
  std::size_t index = 0;
  double share = 0;  ///< 0 to 1
};

/// The place of `x` among `knots`, at least one, whose `key` rises.
template <class Knots, class Key = std::identity>
TablePlace place_among(const Knots& knots, double x, Key key = {}) {
  const auto next = std::ranges::upper_bound(knots, x, {}, key);
  if (next == std::ranges::begin(knots)) return {};
  const auto index = static_cast<std::size_t>(next - std::ranges::begin(knots)) - 1;
  if (next == std::ranges::end(knots)) return {index, 0};
  const double before = std::invoke(key, knots[index]);
  return {index, (x - before) / (std::invoke(key, *next) - before)};
}

/// The value at `place`, where `at(k)` is the one at knot k. Fused as written, not as a compiler
/// likes, so that runs repeat.
template <class At>
double value_at(const TablePlace& place, const At& at) {
  const double value = at(place.index);
  return place.share == 0 ? value : std::fma(place.share, at(place.index + 1) - value, value);
}

}  // namespace hagfish
