#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/program/failure.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/terminal.hpp"
#include "experiments/sweep/grid_reader.hpp"
#include "experiments/sweep/sweep.hpp"

namespace hagfish {
namespace {

constexpr int most_threads = 1024;
constexpr std::size_t progress_lines = 10;

struct SweepArguments {
  std::string grid, out;
  std::string part = "1/1";
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool quiet = false;
};

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
    throw_input_error("--part " + text + ": must be I/N, a part from 1 and their number");
  }
  if (part.index > part.count) {
    throw_input_error(fmt::format("--part {}: there are only {} parts", text, part.count));
  }
  if (part.count > cells) {
    throw_input_error(fmt::format("--part {}: the grid has only {} cells", text, cells));
  }
  return part;
}

int sweep(const SweepArguments& arguments, const std::string& typed) {
  const Grid grid = read_grid(arguments.grid);
  SweepOptions options;
  options.folder = arguments.out;
  options.part = part_of(arguments.part, grid.size());
  options.threads = arguments.threads;
  options.typed = typed;
  options.interrupted = interrupted;
  const std::size_t cells = options.part.cells(grid.size()).size();
  const std::size_t tenth = std::max<std::size_t>(1, cells / progress_lines);
  options.done = [&](std::size_t done) {
    if (!arguments.quiet && done % tenth == 0) say("{} of {} cells\n", done, cells);
  };
  note_signals();
  const SweepOutcome outcome = run_sweep(grid, options);
  if (!outcome.whole()) {
    say("hagfish: {}: interrupted with {} of {} cells done; the same command goes on\n",
        printable(arguments.out), outcome.before + outcome.now, outcome.cells);
    return exit_code::failed;
  }
  if (!arguments.quiet) {
    say("{}: {} cells, {} of them now, in {:.1f} s by {} threads; CPU time {:.1f} s, {:.1f} % of "
        "it "
        "simulation\n",
        printable(arguments.out), outcome.cells, outcome.now, outcome.wall_time, arguments.threads,
        outcome.cpu, outcome.cpu > 0 ? 100 * outcome.simulated / outcome.cpu : 0);
  }
  return exit_code::done;
}

}  // namespace

void add_sweep(Program& program) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* app = program.app.add_subcommand("sweep", "run a grid of settings: a CSV row a run");
  app->add_option("GRID", arguments->grid, "a TOML file: scene, axes, seeds")->required();
  app->add_option("--out", arguments->out, "folder for the table; goes on with what it has")
      ->required();
  app->add_option("--part", arguments->part, "I/N: the I-th of N parts of the cells")
      ->capture_default_str();
  app->add_option("--threads", arguments->threads, "runs side by side (one a core)")
      ->check(from_to(1, most_threads));
  app->add_flag("--quiet", arguments->quiet, "no progress");
  app->callback([arguments, &program] { program.code = sweep(*arguments, program.typed); });
}

}  // namespace hagfish
