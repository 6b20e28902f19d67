// Curvature programs as a scene's table [script.curvature].
#pragma once

#include <vector>

#include "core/input/toml/toml_reader.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// A curvature program as a table: `times` x `stations` values each, a time after the other.
struct ProgramTable {
  std::vector<double> times, stations, bend_y, bend_z, twist;
};

/// Checks `table`, [script.curvature] of the scene of `root`, and turns it into a program. Throws
/// InputError.
CurvatureProgram resolve_table(const TableReader& root, const ProgramTable& table);

/// The reverse, without the noise.
ProgramTable program_table(const CurvatureProgram& program);

}  // namespace hagfish
