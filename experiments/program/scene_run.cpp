#include "experiments/program/scene_run.hpp"

#include <fmt/format.h>

#include <chrono>

#include "core/input/input_text.hpp"
#include "experiments/common/failure.hpp"
#include "experiments/common/progress.hpp"
#include "experiments/common/terminal.hpp"

namespace hagfish {
namespace {

/// How a run ended: the log's status, and the program's exit code.
struct Ending {
  std::string status;
  int code = exit_code::done;
};

/// Steps until the scene is over. A step may take `limit` (s).
Ending take_steps(const Scene& scene, Simulation& sim, double limit, const TakeStep& take,
                  LogWriter& log, Progress& progress) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin;
  sim.solver.stop_when([&begin, limit] {
    return interrupted() || std::chrono::duration<double>(Clock::now() - begin).count() > limit;
  });
  const auto timed = [&](Simulation& of, StepRecord& step) {
    begin = Clock::now();
    take(of, step);
  };
  const auto write = [&](const StepRecord& step, const Simulation& of) {
    log.write(step, of, progress.elapsed());
    progress.warn(step);
    progress.show(step);
  };
  StepRecord record;
  const auto failed = [&sim](const std::string& what, const std::string& when = "") {
    return Ending{fmt::format("failed: {} at step {}{}", what, sim.step, when), exit_code::failed};
  };
  try {
    const Status end = drive(scene, timed, sim, record, {write}, interrupted);
    if (end.ok()) return {"complete", exit_code::done};
    if (interrupted()) return failed("interrupted");
    Ending ending = failed(end.outcome == Outcome::stopped
                               ? fmt::format("a step took longer than --step-limit {:g} s", limit)
                               : end.message,
                           fmt::format(" (t = {:.4f} s, {})", time_of(sim, scene),
                                       phase_name(record.controller.phase)));
    if (end.outcome == Outcome::never_tied || end.outcome == Outcome::knot_lost) {
      ending.code = exit_code::wrong_knot;
    }
    return ending;
  } catch (const std::exception& error) {
    return failed(reason(error));
  }
}

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_flag("--force", options.force, "replace an existing log");
  command.add_flag("--quiet", options.quiet, "no progress");
  command.add_option("--step-limit", options.step_limit, "wall time that a step may take, s")
      ->check(above_zero())
      ->capture_default_str();
}

int take_run(const Model& model, const Scene& scene, Simulation sim, const RunOptions& options,
             LogWriter& log, TakeStep take) {
  if (!take) {
    take = [&](Simulation& of, StepRecord& record) { take_step(model, scene, of, record); };
  }
  note_signals();
  Progress progress(model, scene, options.quiet);
  const Ending ending = take_steps(scene, sim, options.step_limit, take, log, progress);
  progress.end();
  try {
    log.finish(ending.status, sim);
  } catch (const FileError& error) {
    say("hagfish: {}\n", reason(error));
    return exit_code::failed;
  }
  if (ending.code != exit_code::done) {
    say("hagfish: {}\n", printable(options.out + ": " + ending.status));
    return ending.code;
  }
  if (!options.quiet) {
    say("{}: complete after {:.1f} s\n", printable(options.out), progress.elapsed());
  }
  return exit_code::done;
}

}  // namespace hagfish
