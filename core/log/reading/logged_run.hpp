// A run as its log tells it: whether it is a log at all, of which scene, and how to make it again.
#pragma once

#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/log_header.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Throws FileError where `h5` is no log, or of a format version that this program does not read.
void require_log(const Hdf5Reader& h5);

/// How much of its run a log holds; all, where it does not say. Throws FileError where it says what
/// is no level.
LogLevel level_of(const Hdf5Reader& h5);

/// Throws FileError where the log holds less than `least`.
void require_level(const Hdf5Reader& h5, LogLevel least);

/// Throws FileError where another simulator took the steps of the log's run.
void require_own_steps(const Hdf5Reader& h5);

/// The scene of a log, with overrides as of read_scene_source().
ResolvedScene logged_scene(const Hdf5Reader& h5, const std::vector<std::string>& overrides = {});

/// A run that can be made again, to the last bit by the program that made it on a machine of its
/// kind.
struct LoggedRun {
  ResolvedScene resolved;
  std::string qp;                 ///< QP back end
  std::vector<SceneBefore> past;  ///< scenes of a branch before its own
  std::int64_t steps = 0;         ///< step before which the last frame stands
};

/// Why the run of a log cannot be made again; empty where it can.
std::string why_not_again(const Hdf5Reader& h5);

/// Throws FileError where `h5` is no log, or one whose run cannot be made again.
LoggedRun logged_run(const Hdf5Reader& h5);

/// Lets the run `sim`, of the scene `before`, go on in the scene `after`. Throws
/// std::invalid_argument as change_scene().
void branch(const ResolvedScene& before, const ResolvedScene& after, Simulation& sim);

/// Takes a run on until `step` comes next. Throws StepError where a step fails, and FileError where
/// the scene is over before.
void go_on_to(std::int64_t step, const Model& model, const Scene& scene, Simulation& sim);

/// The run at the first step of its log. Throws as go_on_to().
Simulation begin_again(const LoggedRun& run);

}  // namespace hagfish
