// The least length of body that a knot takes.
#pragma once

#include <optional>
#include <string>

#include "core/scene/specimen.hpp"

namespace hagfish {

/// What `knot` takes at least of an open rope pulled tight, in diameters of it: the length of the
/// tightest closed one (ropelength; Ashton, Cantarella, Piatek, Rawdon 2011, J. Exp. Math. 20:57),
/// of which an open one takes no less than 0.6 (10.1 of 16.4 for a 3_1: Pieranski, Przybyl, Stasiak
/// 2001, Eur. Phys. J. E 6:123). Of a composite "A#B" the sum. Nothing of a type without a name.
std::optional<double> least_diameters(const std::string& knot);

/// Why the animal cannot tie `knot`, in one line; empty where it perhaps can.
std::string too_short_for(const Specimen& specimen, const std::string& knot);

}  // namespace hagfish
