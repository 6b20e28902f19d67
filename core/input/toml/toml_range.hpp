// What a value of an input file may be: intervals of numbers, and words.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hagfish {

/// A unit of centimetres, grams and seconds, which numbers in memory are in, and how many of it the
/// same of SI is.
struct Unit {
  const char* cgs = "";
  double per_si = 1;
};
namespace cgs {
inline constexpr Unit one{};
inline constexpr Unit cm{"cm", 1e2}, cm2{"cm^2", 1e4}, gram{"g", 1e3};
inline constexpr Unit speed{"cm/s", 1e2}, acceleration{"cm/s^2", 1e2}, curvature{"rad/cm", 1e-2};
inline constexpr Unit dyn{"dyn", 1e5}, dyn_cm{"dyn cm", 1e7}, stress{"dyn/cm^2", 10};
inline constexpr Unit rigidity{"dyn cm^2", 1e9}, damping{"dyn cm^2 s", 1e9};
inline constexpr Unit spring{"dyn/cm", 1e3}, damper{"dyn s/cm", 1e3}, drag{"g/(s cm)", 10};
}  // namespace cgs

/// The interval from `low` to `high`, with or without its ends. Infinite ends bound nothing.
struct Range {
  double low = -INFINITY;
  double high = INFINITY;
  bool open = false;     ///< the ends are excluded
  std::string rule;      ///< what to tell the user: "must be positive"
  Unit unit = cgs::one;  ///< unit of the number in memory

  bool contains(double x) const { return open ? x > low && x < high : x >= low && x <= high; }
};

/// Words, and what each stands for.
template <class E>
using Choices = std::vector<std::pair<std::string_view, E>>;

/// Every finite number.
inline Range any_number(Unit unit = cgs::one) { return {-INFINITY, INFINITY, false, "", unit}; }

inline Range positive(Unit unit = cgs::one) {
  return {0, INFINITY, true, "must be positive", unit};
}

inline Range not_negative(Unit unit = cgs::one) {
  return {0, INFINITY, false, "must not be negative", unit};
}

/// Shortest text that reads back as the same double.
inline std::string shortest(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  return {buffer, end};
}

/// The interval from `low` to `high`, both included.
inline Range within(double low, double high, Unit unit = cgs::one) {
  return {low, high, false, "must be from " + shortest(low) + " to " + shortest(high), unit};
}

/// `low` or more.
inline Range at_least(double low, Unit unit = cgs::one) {
  return {low, INFINITY, false, "must be at least " + shortest(low), unit};
}

/// Between `low` and `high`, both excluded.
inline Range inside(double low, double high) {
  return {low, high, true, "must be above " + shortest(low) + " and below " + shortest(high), {}};
}

}  // namespace hagfish
