// A grid of runs: scenes and settings along axes, of which each combination is a cell.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"

namespace hagfish {

/// Settings that change together, as often as an axis has places.
struct GridAxis {
  std::vector<std::string> keys;                 ///< dotted; "scene" is the scene itself
  std::vector<std::vector<std::string>> values;  ///< values of each key, at each place; as
                                                 ///< --set has them, or empty: the scene's
  std::size_t size() const { return values.front().size(); }
};

inline constexpr const char* scene_key = "scene";
/// An axis that only draws anew.
inline bool is_seed(const GridAxis& axis) { return axis.keys.front() == "start.seed"; }

enum class KeptLogs { none, failed, all };

struct Grid {
  std::string file;  ///< its name in errors
  std::string scene;
  std::vector<std::string> set;  ///< KEY=VALUE of every cell
  std::vector<GridAxis> axes;    ///< axes of the product; the last one changes first
  KeptLogs keep = KeptLogs::none;

  /// Number of cells.
  std::size_t size() const;
  /// Place of `cell`, below size(), on each axis.
  std::vector<std::size_t> places(std::size_t cell) const;
  /// Keys of all axes, one after the other, and their values at `places`.
  std::vector<std::string> keys() const;
  std::vector<std::string> values(const std::vector<std::size_t>& places) const;
};

/// Scene and animal at `places`. Throws InputError, naming the grid's file.
ResolvedScene scene_at(const Grid& grid, const std::vector<std::size_t>& places);

/// The scene of the first cell with place `place` on axis `axis` that reads: values that contradict
/// each other in some cells are rows there. Throws InputError as the first of those cells where
/// none of the first thousand reads.
ResolvedScene scene_with(const Grid& grid, std::size_t axis, std::size_t place);

/// What makes the rows of a grid what they are: the program, the axes, and a scene with each of
/// their values (scene_with). Lines of text; the same text, the same rows. Throws InputError as
/// scene_with.
std::string grid_identity(const Grid& grid);

}  // namespace hagfish
