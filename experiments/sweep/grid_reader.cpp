#include "experiments/sweep/grid_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/input/files/text_file.hpp"
#include "core/input/input_text.hpp"
#include "core/input/toml/toml_reader.hpp"

namespace hagfish {
namespace {

constexpr int most_places = 10000;  // of an axis: each is tried first, which takes 2 ms
constexpr int most_seeds = 1000000;

enum class Spacing { linear, log };

/// A table { from, to, count, scale } as its values.
std::vector<std::string> read_range(TableReader& table) {
  double from = 0, to = 0;
  int count = 0;
  Spacing spacing = Spacing::linear;
  table.choice("scale", spacing, {{"linear", Spacing::linear}, {"log", Spacing::log}});
  const Range ends = spacing == Spacing::log ? positive() : any_number();
  table.require_all();
  table.number("from", from, ends);
  table.number("to", to, ends);
  table.integer("count", count, within(2, most_places));
  table.finish();
  std::vector<std::string> values;
  for (int i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / (count - 1);
    const double x =
        spacing == Spacing::log ? from * std::pow(to / from, u) : from + u * (to - from);
    values.push_back(fmt::format("{:.9g}", x));
  }
  return values;
}

/// Adds lists and ranges of `table` and the tables in it to `axis`, by dotted key: "model.bodies"
/// may stand in quotes or not.
void read_values(TableReader& table, const std::string& path, GridAxis& axis) {
  const auto add = [&axis](const std::string& key, const std::vector<std::string>& values) {
    axis.keys.push_back(key);
    axis.values.push_back(values);
  };
  for (const std::string& key : table.keys()) {
    const std::string full = path.empty() ? key : fmt::format("{}.{}", path, key);
    if (!table.is_table(key)) {
      std::vector<std::string> values;
      table.values(key, values);
      add(full, values);
      continue;
    }
    table.table(key, [&](TableReader& inner) {
      // Ends without a count are a range that lacks it, unless they are lists of keys' values.
      const bool ends = inner.has("from") && inner.has("to");
      if (inner.has("count") || (ends && !inner.is_array("from") && !inner.is_array("to"))) {
        add(full, read_range(inner));
      } else {
        read_values(inner, full, axis);
      }
    });
  }
}

/// Without keys where the table has none.
GridAxis read_axis(TableReader& table) {
  GridAxis axis;
  read_values(table, "", axis);
  for (std::size_t k = 0; k < axis.keys.size(); ++k) {
    if (const std::size_t count = axis.values[k].size(); count != axis.size()) {
      table.fail(axis.keys[k],
                 fmt::format("has {} values, but {} has {}: keys of one axis change together",
                             count, axis.keys.front(), axis.size()));
    }
  }
  if (!axis.keys.empty() && axis.size() > most_places) {
    table.fail(axis.keys.front(), fmt::format("has more than {} values", most_places));
  }
  return axis;
}

/// An angle is the same key in either unit.
std::string without_unit(const std::string& key) {
  return key.ends_with("_deg") || key.ends_with("_rad") ? key.substr(0, key.size() - 4) : key;
}

/// Whether setting one key sets the other, or part of it.
bool overlap(const std::string& a, const std::string& b) {
  const std::string x = without_unit(a) + ".", y = without_unit(b) + ".";
  return x.starts_with(y) || y.starts_with(x);
}

/// Each key stands once. The axis of seeds, where there is one, is the last.
void check_keys(const TableReader& root, const Grid& grid, bool has_seeds) {
  std::vector<std::pair<std::string, std::string>> seen;  // key, and where it stands
  try {
    for (const std::string& assignment : grid.set) {
      seen.emplace_back(parse_override(assignment).key, "set");
    }
  } catch (const InputError& error) {
    root.fail("set", error.what());
  }
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    const bool seeds = has_seeds && a + 1 == grid.axes.size();
    for (const std::string& key : grid.axes[a].keys) {
      for (const auto& [other, where] : seen) {
        if (!overlap(key, other)) continue;
        const std::string why = other == key
                                    ? fmt::format("{} is also set in {}", key, where)
                                    : fmt::format("{} overlaps with {} of {}", key, other, where);
        if (seeds) root.fail("seeds", why);
        root.fail_element("axis", a, why);
      }
      seen.emplace_back(key, fmt::format("axis {}", a + 1));
    }
  }
}

/// The scene that a grid file names: a file beside it, or a built-in one.
std::string beside(const std::filesystem::path& file, const std::string& scene) {
  const bool names_file = std::filesystem::path(scene).extension() == ".toml";
  return names_file ? (file.parent_path() / scene).string() : scene;
}

/// Reads the scene of every value once, but of seeds, which are all alike. Returns whether any of
/// them has noise at its start.
bool try_values(const Grid& grid) {
  bool noisy = false;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    const std::size_t end = is_seed(grid.axes[a]) ? 1 : grid.axes[a].size();
    for (std::size_t place = 0; place < end; ++place) {
      noisy = scene_with(grid, a, place).scene.start.noise > 0 || noisy;
    }
  }
  return noisy;
}

}  // namespace

Grid read_grid(const std::filesystem::path& file) {
  TableReader root(read_text_file(file), file.string());
  Grid grid;
  grid.file = file.string();
  root.string("scene", grid.scene);
  if (root.has("set")) root.values("set", grid.set);
  root.choice("keep", grid.keep,
              {{"none", KeptLogs::none}, {"failed", KeptLogs::failed}, {"all", KeptLogs::all}});
  root.tables("axis", [&](TableReader& table) { grid.axes.push_back(read_axis(table)); });
  int seeds = 0;
  root.integer("seeds", seeds, within(1, most_seeds));
  root.finish();
  if (seeds > 0) {
    GridAxis axis{{"start.seed"}, {{}}};
    for (int seed = 1; seed <= seeds; ++seed) {
      axis.values.front().push_back(std::to_string(seed));
    }
    grid.axes.push_back(axis);
  }
  if (grid.axes.empty()) root.fail("axis", "is missing: give an axis or seeds");
  double cells = 1;
  bool has_scene = !grid.scene.empty();
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    GridAxis& axis = grid.axes[a];
    if (axis.keys.empty()) root.fail_element("axis", a, "has no key");
    cells *= static_cast<double>(axis.size());
    for (std::size_t k = 0; k < axis.keys.size(); ++k) {
      if (axis.keys[k] != scene_key) continue;
      if (!grid.scene.empty())
        root.fail_element("axis", a, "has a scene, but the file names one too");
      has_scene = true;
      for (std::string& name : axis.values[k]) name = beside(file, name);
    }
  }
  check_keys(root, grid, seeds > 0);
  if (!has_scene) root.fail("scene", "is missing");
  if (cells > most_cells) {
    root.fail("axis", fmt::format("makes {:g} cells; at most {:g} are allowed", cells, most_cells));
  }
  grid.scene = beside(file, grid.scene);
  if (!try_values(grid) && seeds > 1) {
    root.fail("seeds", "start.noise_deg is 0: runs would be all alike");
  }
  return grid;
}

}  // namespace hagfish
