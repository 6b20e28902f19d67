// A sweep as commands run it: what it says, and how a signal ends it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "experiments/sweep/sweep.hpp"

namespace hagfish {

struct SweepArguments {
  std::string out;  ///< folder
  int threads = 0;  ///< 0: one a core
  bool quiet = false;
};

/// --out, --threads and --quiet.
void add_sweep_options(CLI::App& app, SweepArguments& arguments);

/// Runs what `part` of the grid has not yet. Returns whether all of it is done; says so where it
/// was interrupted. Throws as run_sweep.
bool run_told_sweep(const Grid& grid, const SweepPart& part, const SweepArguments& arguments,
                    const std::string& typed);

}  // namespace hagfish
