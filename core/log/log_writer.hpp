// Writes a run as HDF5, format `hagfish-log` version 1. Beyond the contract it adds what an audit
// needs: every step under /steps, the next velocity, and the full energy ledger; and checkpoints.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/log/checkpoint.hpp"
#include "core/log/hdf5_reader.hpp"
#include "core/log/log_header.hpp"
#include "core/log/output_file.hpp"
#include "core/log/saved_run.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Steps from one frame to the next, and from one checkpoint to the next.
std::int64_t frame_stride(const TimeSettings& time);
std::int64_t checkpoint_stride(const TimeSettings& time);

class LogWriter {
 public:
  /// Writes to FILE.part until finish(). Throws FileError as OutputFile, or where the header cannot
  /// be written.
  LogWriter(const std::filesystem::path& file, bool replace, const LogHeader& header,
            const Model& model, const Scene& scene);
  /// Goes on with FILE, the log of `run`, as it was `read`: FILE.part becomes what was read, as
  /// HDF5 may crash on what it was read from. Throws FileError as OutputFile, or where the log
  /// lacks rows; then it stays as it is.
  LogWriter(const std::filesystem::path& file, const SavedRun& run, const Hdf5Reader& read);
  /// Without finish(), FILE.part stays as it was last saved, but for one without any step.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Takes in one step, after which the run is `sim`; every scene.time.frame_interval it becomes a
  /// frame. `wall_time`: since the run began, s. After the first step, and a second of wall time
  /// after each save, the log is saved with all that the run needs to go on, whatever ends the
  /// process. Throws FileError where that fails, and in a forked child.
  void write(const StepRecord& record, const Simulation& sim, double wall_time);

  /// Sets the status ("complete" or "failed: CAUSE") of the run, now `sim`, whose state becomes the
  /// last frame where there was a step (end_of_run.hpp), closes the log and gives it its name.
  /// Throws FileError where that fails; FILE.part is then as it was last saved, if possible with
  /// the status "failed: CAUSE".
  void finish(const std::string& status, const Simulation& sim);

 private:
  void require_ours() const;
  void write_frame(const StepRecord& record, const ThigmotaxisRows& rows);
  struct Contents;
  std::unique_ptr<OutputFile> output_;
  std::unique_ptr<Contents> contents_;
};

}  // namespace hagfish
