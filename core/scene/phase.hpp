// The phases of an experiment.
#pragma once

#include <cstdint>

#include "core/scene/enumeration.hpp"

namespace hagfish {

/// Logs hold these numbers: a new phase comes last.
enum class Phase : std::uint8_t { form, tighten, slide, release, free, reverse, pull, last = pull };

struct PhaseEntry {
  Phase value;
  const char* name;
  const char* description;
  bool optional = false;  ///< whether only scenes that ask for it have it
};

/// Phases in the order of time.
inline constexpr TableOf<PhaseEntry> phase_table{{{Phase::form, "form", "knot forming"},
                                                  {Phase::tighten, "tighten", "tightening"},
                                                  {Phase::slide, "slide", "sliding"},
                                                  {Phase::pull, "pull", "pulling", true},
                                                  {Phase::reverse, "reverse", "sliding back", true},
                                                  {Phase::release, "release", "released"},
                                                  {Phase::free, "free", "free"}}};
static_assert(lists_each_once(phase_table));

/// Place of a phase in time.
constexpr int phase_order(Phase phase) { return static_cast<int>(index_in(phase_table, phase)); }

constexpr const char* phase_name(Phase phase) {
  return phase_table[index_in(phase_table, phase)].name;
}

/// The knot must stay tied: from tightening to release.
constexpr bool holds_knot(Phase phase) {
  return phase_order(phase) >= phase_order(Phase::tighten) &&
         phase_order(phase) < phase_order(Phase::release);
}

}  // namespace hagfish
