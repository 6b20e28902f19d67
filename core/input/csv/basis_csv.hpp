// Learned shapes of a reduced basis as CSV: a heading, then a row for each shape and station, a
// shape after the other and in each all stations, head to tail.
#pragma once

#include <string>

#include "core/scene/settings.hpp"

namespace hagfish {

/// The columns of a basis that lies along the animal. Along the knot's window the second is
/// window_station_column.
inline constexpr const char* basis_columns[] = {"shape", "station (cm)", "bend_y (1)", "bend_z (1)",
                                                "twist (1)"};
inline constexpr const char* window_station_column = "station (window)";

/// Reads the shapes in `text` into `basis`, whose frame says what they lie along; `name` stands for
/// their file in errors. Throws InputError, one line, for a column that is missing, what is no
/// finite number, rows that are not shapes x stations, and stations that do not rise from 0 to
/// `length` (cm), that of the animal, or to 1 in a window: those are of another body.
void read_basis_csv(const std::string& text, const std::string& name, double length,
                    ReducedBasisSettings& basis);

}  // namespace hagfish
