#include <fmt/format.h>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/common/idle_settings.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/told_sweep.hpp"
#include "experiments/sweep/grid_reader.hpp"

namespace hagfish {
namespace {

/// "I/N" of a grid of `cells`.
SweepPart part_of(const std::string& text, std::size_t cells) {
  const std::size_t slash = text.find('/');
  const auto whole = [](const std::string& part) {
    const bool digits = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
    return digits && part.size() <= 9 ? std::stoul(part) : 0;
  };
  const SweepPart part{whole(text.substr(0, slash)),
                       slash == std::string::npos ? 0 : whole(text.substr(slash + 1))};
  if (part.index < 1 || part.count < 1) {
    throw_input_error("--part " + text + ": must be I/N, part I (from 1) of N parts");
  }
  if (part.index > part.count) {
    throw_input_error(fmt::format("--part {}: there are only {} parts", text, part.count));
  }
  if (part.count > cells) {
    throw_input_error(fmt::format("--part {}: the grid has only {} cells", text, cells));
  }
  return part;
}

/// Throws InputError where a key of the file does nothing in any of its scenes.
void require_keys_act(const Grid& grid) {
  std::vector<Scene> scenes;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    for (std::size_t place = 0; place < (is_seed(grid.axes[a]) ? 1 : grid.axes[a].size());
         ++place) {
      scenes.push_back(scene_with(grid, a, place).scene);
    }
  }
  std::vector<std::string> keys = grid.keys();
  keys.insert(keys.end(), grid.set.begin(), grid.set.end());
  try {
    require_settings_act_somewhere(scenes, keys);
  } catch (const InputError& error) {
    throw_input_error(grid.file + ": " + error.what());
  }
}

}  // namespace

void add_sweep(Program& program) {
  struct Options {
    SweepArguments sweep;
    std::string grid, part = "1/1";
  };
  const auto options = std::make_shared<Options>();
  CLI::App* app = program.app.add_subcommand("sweep", "run a grid of settings: a CSV row a run");
  app->add_option("GRID", options->grid, "a TOML file: scene, axes, seeds")->required();
  add_sweep_options(*app, options->sweep);
  app->add_option("--part", options->part, "I/N: the I-th of N parts of the cells")
      ->capture_default_str();
  app->callback([options, &program] {
    const Grid grid = read_grid(options->grid);
    require_keys_act(grid);
    const bool whole =
        run_told_sweep(grid, part_of(options->part, grid.size()), options->sweep, program.typed);
    program.code = whole ? exit_code::done : exit_code::failed;
  });
}

}  // namespace hagfish
