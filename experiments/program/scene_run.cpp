#include "experiments/program/scene_run.hpp"

#include <fmt/format.h>

#include <chrono>

#include "core/input/input_text.hpp"
#include "experiments/program/failure.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/progress.hpp"
#include "experiments/program/terminal.hpp"

namespace hagfish {
namespace {

/// How a run ended: the log's status, and the program's exit code.
struct Ending {
  std::string status;
  int code = exit_code::done;
};

/// Why a step was stopped: by whom, or by the limit.
std::string reason_of_stop(double limit) {
  return interrupted() ? "interrupted"
                       : fmt::format("a step took longer than --step-limit {:g} s", limit);
}

/// Steps until the scene is over.
Ending take_steps(const Scene& scene, Simulation& sim, double limit, const TakeStep& take,
                  LogWriter& log, Progress& progress) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin;
  sim.solver.stop_when([&begin, limit] {
    return interrupted() || std::chrono::duration<double>(Clock::now() - begin).count() > limit;
  });
  StepRecord record;
  while (!finished(sim, scene)) {
    if (interrupted()) {
      return {fmt::format("failed: interrupted at step {}", sim.step), exit_code::failed};
    }
    try {
      begin = Clock::now();
      take(sim, record);
      log.write(record, sim, progress.elapsed());
      progress.warn(record);
      progress.show(record);
    } catch (const StepError& error) {
      const bool knot =
          error.outcome() == Outcome::never_tied || error.outcome() == Outcome::knot_lost;
      const std::string what =
          error.outcome() == Outcome::stopped ? reason_of_stop(limit) : error.what();
      return {fmt::format("failed: {} at step {} (t = {:.4f} s, {})", what, sim.step,
                          time_of(sim, scene), phase_name(record.controller.phase)),
              knot ? exit_code::wrong_knot : exit_code::failed};
    } catch (const std::exception& error) {
      return {fmt::format("failed: {} at step {}", reason(error), sim.step), exit_code::failed};
    }
  }
  return {"complete", exit_code::done};
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
             LogWriter& log, double before, TakeStep take) {
  if (!take) {
    take = [&](Simulation& of, StepRecord& record) { take_step(model, scene, of, record); };
  }
  note_signals();
  Progress progress(model, scene, options.quiet, before);
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
    say("{}: complete after {:.1f} s\n", options.out, progress.elapsed());
  }
  return exit_code::done;
}

}  // namespace hagfish
