// Writes a run as HDF5, format `hagfish-log` version 1. Beyond the contract it adds what an audit
// needs: every step under /steps, the next velocity, and the full energy ledger.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/log/output_file.hpp"
#include "core/log/thigmotaxis_rows.hpp"
#include "core/run/simulation.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

inline constexpr const char* log_format = "hagfish-log";
inline constexpr int log_format_version = 1;

/// How a log came about.
struct LogHeader {
  std::string command;  ///< as typed
  std::string scene;    ///< fully resolved TOML
  std::string qp;       ///< QP back end
  std::string libraries;
  std::map<std::string, std::string> mjcf;  ///< the mirrored model's files by name
};

/// Steps from one frame to the next.
std::int64_t frame_stride(const TimeSettings& time);

class LogWriter {
 public:
  /// Writes to FILE.part until finish(). Throws FileError as OutputFile, or where the header cannot
  /// be written.
  LogWriter(const std::filesystem::path& file, bool replace, const LogHeader& header,
            const Model& model, const Scene& scene);
  /// Without finish(), FILE.part stays as it was last saved, but for one without any step.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Takes in one step; every scene.time.frame_interval it becomes a frame. `wall_time`: since the
  /// run began, s. Now and then the log is saved, so that a crash loses a second of wall time or,
  /// of a long log, a hundred times what a save takes. Throws FileError where a save fails.
  void write(const StepRecord& record, double wall_time);

  /// Sets the status ("complete" or "failed: CAUSE"), closes the log and gives it its name. Throws
  /// FileError where that fails; FILE.part is then as it was last saved, if possible with the
  /// status "failed: CAUSE".
  void finish(const std::string& status);

 private:
  void write_frame(const StepRecord& record, const ThigmotaxisRows& rows, double wall_time);
  struct Contents;
  OutputFile file_;
  std::unique_ptr<Contents> contents_;
};

}  // namespace hagfish
