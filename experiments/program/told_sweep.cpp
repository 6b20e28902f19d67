#include "experiments/program/told_sweep.hpp"

#include <algorithm>

#include "core/input/input_text.hpp"
#include "experiments/common/cores.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

constexpr int most_threads = 1024;
constexpr std::size_t progress_lines = 10;

}  // namespace

void add_sweep_options(CLI::App& app, SweepArguments& arguments) {
  app.add_option("--out", arguments.out,
                 "folder for the table; a table that was begun is continued")
      ->required();
  app.add_option("--threads", arguments.threads, "runs side by side (one a core)")
      ->check(from_to(1, most_threads));
  app.add_flag("--quiet", arguments.quiet, "no progress");
}

bool run_told_sweep(const Grid& grid, const SweepPart& part, const SweepArguments& arguments,
                    const std::string& typed) {
  SweepOptions options;
  options.folder = arguments.out;
  options.part = part;
  options.threads = arguments.threads > 0 ? arguments.threads : usable_cores();
  options.typed = typed;
  options.interrupted = interrupted;
  const std::size_t cells = part.cells(grid.size()).size();
  const std::size_t tenth = std::max<std::size_t>(1, cells / progress_lines);
  options.done = [&](std::size_t done) {
    if (!arguments.quiet && done % tenth == 0) say("{} of {} cells\n", done, cells);
  };
  note_signals();
  const SweepOutcome outcome = run_sweep(grid, options);
  if (!outcome.whole()) {
    say("hagfish: {}: interrupted with {} of {} cells done; the same command continues\n",
        printable(arguments.out), outcome.before + outcome.now, outcome.cells);
    return false;
  }
  if (!arguments.quiet) {
    say("{}: {} cells, {} of them now, in {:.1f} s by {} threads; CPU time {:.1f} s, {:.1f} % of "
        "it "
        "simulation\n",
        printable(arguments.out), outcome.cells, outcome.now, outcome.wall_time, options.threads,
        outcome.cpu, outcome.cpu > 0 ? 100 * outcome.simulated / outcome.cpu : 0);
  }
  return true;
}

}  // namespace hagfish
