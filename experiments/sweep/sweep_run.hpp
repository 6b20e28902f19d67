// One run of a sweep.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/input/files/scene_reader.hpp"
#include "experiments/judge/judge.hpp"

namespace hagfish {

/// CPU time that a step may take, s: far more than any; so that none is endless. Of CPU, not of the
/// clock, since jobs of a cluster may be suspended.
inline constexpr double step_cpu_limit = 60;

/// CPU time of the calling thread, s.
double thread_cpu_time();

/// A log to be written. Debian's HDF5 is not safe in several threads: all that touches it holds
/// `hdf5`.
struct SweepLog {
  std::filesystem::path file;  ///< replaced
  std::string typed;           ///< the command line, for its header
  std::mutex& hdf5;
};

struct SweepRun {
  RunSummary summary;
  double cpu_time = 0;  ///< CPU time of taking steps, s
};

/// Runs a scene to its end. Nothing where `interrupted` ended it. Throws FileError where the log
/// cannot be written; what a run throws but StepError becomes the outcome "error".
std::optional<SweepRun> run_for_summary(const ResolvedScene& resolved,
                                        const std::function<bool()>& interrupted,
                                        const std::optional<SweepLog>& log);

}  // namespace hagfish
