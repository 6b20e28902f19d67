// What a value of an input file may be: intervals of numbers, and words.
#pragma once

#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hagfish {

/// The interval from `low` to `high`, with or without its ends. Infinite ends bound nothing.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;  ///< the ends are excluded
  std::string rule;   ///< what to tell the user: "must be positive"

  bool contains(double x) const { return open ? x > low && x < high : x >= low && x <= high; }
};

/// Words, and what each stands for.
template <class E>
using Choices = std::vector<std::pair<std::string_view, E>>;

/// Every finite number.
inline Range any_number() { return {}; }

inline Range positive() {
  return {0, std::numeric_limits<double>::infinity(), true, "must be positive"};
}

inline Range not_negative() {
  return {0, std::numeric_limits<double>::infinity(), false, "must not be negative"};
}

/// Shortest text that reads back as the same double.
inline std::string shortest(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  return {buffer, end};
}

/// From `low` to `high`, both included.
inline Range within(double low, double high) {
  return {low, high, false, "must be from " + shortest(low) + " to " + shortest(high)};
}

/// `low` or more.
inline Range at_least(double low) {
  return {low, std::numeric_limits<double>::infinity(), false, "must be at least " + shortest(low)};
}

/// Between `low` and `high`, both excluded.
inline Range inside(double low, double high) {
  return {low, high, true, "must be above " + shortest(low) + " and below " + shortest(high)};
}

}  // namespace hagfish
