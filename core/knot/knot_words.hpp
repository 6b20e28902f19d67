// Knots as people call them.
#pragma once

#include <string>
#include <string_view>

#include "core/knot/knot.hpp"

namespace hagfish {

/// "overhand, 3_1" of a knot_name() that people have a name for, "no knot" of "0_1", else itself.
std::string knot_words(std::string_view name);
inline std::string knot_words(const KnotInvariants& type) { return knot_words(knot_name(type)); }

/// "no knot", or "a knot (overhand, 3_1)".
std::string a_knot(std::string_view name);

}  // namespace hagfish
