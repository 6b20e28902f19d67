#include "experiments/design/length_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace hagfish {
namespace {

/// Ropelength over the rope's diameter of the tightest closed knots known.
constexpr auto closed_diameters = std::to_array<std::pair<const char*, double>>({{"3_1", 16.37},
                                                                                 {"4_1", 21.04},
                                                                                 {"5_1", 23.60},
                                                                                 {"5_2", 24.74},
                                                                                 {"6_1", 28.35},
                                                                                 {"6_2", 28.51},
                                                                                 {"6_3", 28.92},
                                                                                 {"7_1", 30.70},
                                                                                 {"7_2", 31.93},
                                                                                 {"7_3", 31.96},
                                                                                 {"7_4", 32.13},
                                                                                 {"7_5", 32.63},
                                                                                 {"7_6", 32.85},
                                                                                 {"7_7", 32.80}});
constexpr double open_share = 0.6;

}  // namespace

std::optional<double> least_diameters(const std::string& knot) {
  if (const std::size_t sum = knot.find('#'); sum != std::string::npos) {
    const std::optional<double> first = least_diameters(knot.substr(0, sum));
    const std::optional<double> second = least_diameters(knot.substr(sum + 1));
    return first && second ? std::optional(*first + *second) : std::nullopt;
  }
  const std::string prime = knot.starts_with('-') ? knot.substr(1) : knot;
  const auto* const found = std::ranges::find_if(
      closed_diameters, [&](const auto& entry) { return entry.first == prime; });
  if (found == closed_diameters.end()) return std::nullopt;
  return open_share * found->second;
}

std::string too_short_for(const Specimen& specimen, const std::string& knot) {
  const std::optional<double> least = least_diameters(knot);
  const double diameter = mean_diameter(specimen);
  if (!least || *least * diameter <= specimen.length) return "";
  return fmt::format(
      "{} needs at least {:.1f} cm of body of this girth (ropelength), yours has {:.1f}", knot,
      *least * diameter, specimen.length);
}

}  // namespace hagfish
