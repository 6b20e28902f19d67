// What the commands that make a log share: `run` and `branch`.
#pragma once

#include <functional>
#include <string>

#include "core/log/log_writer.hpp"
#include "core/run/drive.hpp"
#include "experiments/common/run_header.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {

struct RunOptions {
  std::string out;  ///< log to write
  bool force = false;
  bool quiet = false;
  double step_limit = 60;  ///< wall time that a step may take, s
};

/// Adds --force, --quiet and --step-limit.
void add_run_options(CLI::App& command, RunOptions& options);

/// Steps until the scene is over, or something ends the run, and finishes the log. `take` is
/// take_step() by default. Returns the exit code.
int take_run(const Model& model, const Scene& scene, Simulation sim, const RunOptions& options,
             LogWriter& log, TakeStep take = {});

}  // namespace hagfish
