// A run as it stands in its log, to be gone on with.
#pragma once

#include <filesystem>
#include <string>

#include "core/input/scene_reader.hpp"
#include "core/log/checkpoint.hpp"
#include "core/log/hdf5_reader.hpp"
#include "core/log/log_level.hpp"

namespace hagfish {

// Datasets of the checkpoints: all but the last one in one row of bytes.
inline constexpr const char* checkpoint_data = "/checkpoints/data";
inline constexpr const char* last_checkpoint = "/checkpoints/last";

/// Throws FileError where `h5` is no log, or of a format version that this program does not read.
void require_log(const Hdf5Reader& h5);

/// How much of its run a log holds; all, where it does not say. Throws FileError where it says what
/// is no level.
LogLevel level_of(const Hdf5Reader& h5);

/// Throws FileError where the log holds less than `least`.
void require_level(const Hdf5Reader& h5, LogLevel least);

/// Throws FileError where another simulator took the steps of the log's run.
void require_own_steps(const Hdf5Reader& h5);

/// A run between two steps, as a log holds it.
struct LoggedCheckpoint {
  std::int64_t step = 0;  ///< that comes next
  std::vector<std::uint8_t> bytes;
};

/// Those at intervals, in their order; the last one, where the log ends, is not among them. Throws
/// FileError where the datasets do not fit each other.
std::vector<LoggedCheckpoint> logged_checkpoints(const Hdf5Reader& h5);

struct SavedRun {
  ResolvedScene resolved;
  Model model;
  std::string qp;                   ///< QP back end
  LogLevel level = LogLevel::full;  ///< of its log
  Simulation sim;
  LogState log;
  double wall_time = 0;      ///< that the run took so far, to its last frame, s
  std::string resumed;       ///< steps at which it was gone on with before, as a list
  std::string git_revision;  ///< of the program that made the log
};

/// The run where its log ends. Throws FileError where `h5` is no log, is complete, or has no
/// checkpoint that fits its scene.
SavedRun saved_run(const Hdf5Reader& h5);

/// The run as it stood at its last checkpoint up to `time` (s), of a log of whatever status.
/// Throws FileError where there is none.
SavedRun saved_run_at(const Hdf5Reader& h5, double time);

}  // namespace hagfish
