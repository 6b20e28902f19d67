// Linear interpolation in a table: values at rising nodes, constant outside of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace hagfish {

/// Where a number lies in a table: the last node at or before it, and the share of the way to the
/// next; share 0 outside, at the first or the last node.
struct Bracket {
  std::size_t index = 0;
  double share = 0;  ///< 0 to 1
};

/// The bracket of `x` among `nodes`, at least one, whose `key` rises.
template <class Nodes, class Key = std::identity>
Bracket bracket_of(const Nodes& nodes, double x, Key key = {}) {
  const auto next = std::ranges::upper_bound(nodes, x, {}, key);
  if (next == std::ranges::begin(nodes)) return {};
  const auto index = static_cast<std::size_t>(next - std::ranges::begin(nodes)) - 1;
  if (next == std::ranges::end(nodes)) return {index, 0};
  const double before = std::invoke(key, nodes[index]);
  return {index, (x - before) / (std::invoke(key, *next) - before)};
}

/// The value at `bracket`, where `at(k)` is the one at node k. Fused as written, not as a compiler
/// likes, so that runs repeat.
template <class At>
double value_at(const Bracket& bracket, const At& at) {
  const double value = at(bracket.index);
  return bracket.share == 0 ? value : std::fma(bracket.share, at(bracket.index + 1) - value, value);
}

}  // namespace hagfish
