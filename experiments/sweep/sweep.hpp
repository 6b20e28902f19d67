// Runs the cells of a grid side by side in one process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "experiments/sweep/grid.hpp"
#include "experiments/sweep/sweep_table.hpp"

namespace hagfish {

/// Back end of all runs of a sweep: the project's own code, which threads can share. Ipopt with
/// MUMPS is not safe in several threads.
inline constexpr const char* sweep_qp = "active-set";

struct SweepOptions {
  std::filesystem::path folder;
  SweepPart part;
  int threads = 1;
  std::string typed;                      ///< the command line, for logs
  std::function<bool()> interrupted;      ///< asked at each step, by every thread
  std::function<void(std::size_t)> done;  ///< how many cells have a row; by one thread at a time
};

/// How a sweep went.
struct SweepOutcome {
  std::size_t cells = 0, before = 0, now = 0;  ///< cells of the part; with rows before; made now
  double wall_time = 0;                        ///< s
  double simulated = 0, cpu = 0;               ///< CPU time of taking steps, and of the process, s
  bool whole() const { return before + now == cells; }
};

/// Runs the cells of a part that have no row yet: table.csv and times.csv in the folder
/// (SweepTable), logs/CELL.h5 of those that are kept. Rows do not depend on the number of threads
/// or parts. A cell whose settings contradict each other is a row, with the outcome "refused".
/// Throws FileError where the folder holds another sweep or cannot be written, InputError as
/// scene_at.
SweepOutcome run_sweep(const Grid& grid, const SweepOptions& options);

}  // namespace hagfish
