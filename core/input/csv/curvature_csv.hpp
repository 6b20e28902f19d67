// Curvature programs as CSV: a heading, then a row for each time and station, a time after the
// other and in each all stations, head to tail.
#pragma once

#include <string>

#include "core/scene/settings.hpp"

namespace hagfish {

/// The columns, by these names with their units: a file in other units has other names.
inline constexpr const char* curvature_columns[] = {"time (s)", "station (L)", "bend_y (rad/L)",
                                                    "bend_z (rad/L)", "twist (rad/L)"};

/// The program in `text`; `name` stands for its file in errors. Lines that begin with # are
/// comments; separators and encodings as DelimitedText reads them. Throws InputError, one line, for
/// a column that is missing, what is no finite number, and rows that are not times x stations, each
/// rising.
CurvatureProgram read_curvature_csv(const std::string& text, const std::string& name);

/// The text from which read_curvature_csv() makes `program`, without its noise, rounded to
/// curvature_rounding.
std::string curvature_csv(const CurvatureProgram& program);

/// Rounding of a written program's values, rad per body length: a hinge of 100 bodies, which takes
/// a fiftieth of it, cannot tell.
inline constexpr double curvature_rounding = 1e-3;

}  // namespace hagfish
