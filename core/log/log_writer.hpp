// Writes a run as HDF5, format `hagfish-log` version 1. Beyond the contract it adds what an audit
// needs: every step under /steps, the next velocity, and the full energy ledger.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/log/hdf5/output_file.hpp"
#include "core/log/log_header.hpp"
#include "core/log/means/thigmotaxis_rows.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Steps from one frame to the next.
std::int64_t frame_stride(const TimeSettings& time);

/// Rows go to a copy of FILE.part, which takes its name at each save: whatever ends the process,
/// FILE.part is whole, and who reads it has what was saved when it was opened.
class LogWriter {
 public:
  /// Writes to FILE.part until finish(). `steps`: where FILE or FILE.part is a log of this run
  /// already (Existing::go_on, whatever `replace` says), those that it has; it stays until this one
  /// has as many. Throws FileError as OutputFile, or where the header cannot be written.
  LogWriter(const std::filesystem::path& file, bool replace, const LogHeader& header,
            const Model& model, const Scene& scene,
            std::optional<std::int64_t> steps = std::nullopt);
  /// Without finish(), FILE.part stays as it was last saved.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Takes in one step, after which the run is `sim`; every scene.time.frame_interval it becomes a
  /// frame. `wall_time`: since the run began, s. After the first step, and then after 1 s or a
  /// tenth of the wall time, the log is saved. Throws FileError where that fails, and in a forked
  /// child.
  void write(const StepRecord& record, const Simulation& sim, double wall_time);

  /// Sets the status ("complete" or "failed: CAUSE") of the run, now `sim`, whose state becomes the
  /// last frame where there was a step (end_record()), closes the log and gives it its name.
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
