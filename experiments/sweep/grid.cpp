#include "experiments/sweep/grid.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <numeric>

#include "core/input/input_text.hpp"
#include "core/log/build_info.hpp"
#include "experiments/common/scene_argument.hpp"

namespace hagfish {
namespace {

constexpr int most_tried = 1000;  // cells with one value: 2 ms each

/// FNV-1a, 64 bits: tells a text from another one, where nobody means harm.
std::uint64_t checksum(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

/// Goes on to the next places of all axes but `axis` and that of seeds, which are all alike; false
/// after the last.
bool advance(const Grid& grid, std::size_t axis, std::vector<std::size_t>& places) {
  for (std::size_t a = grid.axes.size(); a-- > 0;) {
    if (a == axis || is_seed(grid.axes[a])) continue;
    if (++places[a] < grid.axes[a].size()) return true;
    places[a] = 0;
  }
  return false;
}

}  // namespace

std::size_t Grid::size() const {
  return std::accumulate(
      axes.begin(), axes.end(), std::size_t{1},
      [](std::size_t count, const GridAxis& axis) { return count * axis.size(); });
}

std::vector<std::size_t> Grid::places(std::size_t cell) const {
  std::vector<std::size_t> at(axes.size());
  for (std::size_t a = axes.size(); a-- > 0; cell /= axes[a].size()) {
    at[a] = cell % axes[a].size();
  }
  return at;
}

std::vector<std::string> Grid::keys() const {
  std::vector<std::string> all;
  for (const GridAxis& axis : axes) {
    all.insert(all.end(), axis.keys.begin(), axis.keys.end());
  }
  return all;
}

std::vector<std::string> Grid::values(const std::vector<std::size_t>& places) const {
  std::vector<std::string> all;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (const std::vector<std::string>& of_key : axes[a].values) {
      all.push_back(of_key[places[a]]);
    }
  }
  return all;
}

ResolvedScene scene_at(const Grid& grid, const std::vector<std::size_t>& places) {
  const std::vector<std::string> keys = grid.keys();
  const std::vector<std::string> values = grid.values(places);
  std::string scene = grid.scene;
  std::vector<std::string> overrides = grid.set;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k] == scene_key) {
      scene = values[k];
    } else if (!values[k].empty()) {
      overrides.push_back(keys[k] + "=" + values[k]);
    }
  }
  try {
    return scene_argument(scene, overrides);
  } catch (const InputError& error) {
    throw_input_error(grid.file + ": " + error.what());
  }
}

ResolvedScene scene_with(const Grid& grid, std::size_t axis, std::size_t place) {
  std::vector<std::size_t> places(grid.axes.size(), 0);
  places[axis] = place;
  std::exception_ptr first;
  for (int tried = 0; tried < most_tried; ++tried) {
    try {
      return scene_at(grid, places);
    } catch (const InputError&) {
      if (!first) first = std::current_exception();
    }
    if (!advance(grid, axis, places)) break;
  }
  std::rethrow_exception(first);
}

std::string grid_identity(const Grid& grid) {
  const auto scene_text = [&](std::size_t axis, std::size_t place) {
    const ResolvedScene resolved = scene_with(grid, axis, place);
    return scene_to_toml(resolved.scene, resolved.specimen);
  };
  std::string text = fmt::format("# The sweep in this folder. By hagfish {} {}\n", build_version(),
                                 build_revision());
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    const GridAxis& axis = grid.axes[a];
    for (std::size_t place = 0; place < axis.size(); ++place) {
      text += fmt::format("# axis {}: ", a + 1);
      for (std::size_t k = 0; k < axis.keys.size(); ++k) {
        text += fmt::format("{} = {}, ", axis.keys[k], axis.values[k][place]);
      }
      text += is_seed(axis) ? "\n" : fmt::format("scene {:016x}\n", checksum(scene_text(a, place)));
    }
  }
  return text + "# The scene of the first cell:\n" + scene_text(0, 0);
}

}  // namespace hagfish
