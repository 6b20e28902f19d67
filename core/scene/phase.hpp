// The phases of an experiment, in the log's numbering.
#pragma once

#include <cstdint>

namespace hagfish {

/// Between slide and release come `reverse`, where the knot leaves by the tail, or `pull`, where
/// the head pulls at food; their numbers are the last ones because logs hold these numbers.
enum class Phase : std::uint8_t { form, tighten, slide, release, free, reverse, pull };
inline constexpr int phase_count = 7;

constexpr const char* phase_name(Phase phase) {
  constexpr const char* names[phase_count] = {"form", "tighten", "slide", "release",
                                              "free", "reverse", "pull"};
  return names[static_cast<int>(phase)];
}

/// Place of a phase in time: form, tighten, slide, pull, reverse, release, free.
constexpr int phase_order(Phase phase) {
  constexpr int order[phase_count] = {0, 1, 2, 5, 6, 4, 3};
  return order[static_cast<int>(phase)];
}

/// The knot must stay tied: from tightening to release.
constexpr bool holds_knot(Phase phase) {
  return phase_order(phase) >= phase_order(Phase::tighten) &&
         phase_order(phase) < phase_order(Phase::release);
}

}  // namespace hagfish
