// Studies beside MuJoCo. Each prints a table and leaves what it is made of in an HDF5 file.
#pragma once

#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"
#include "core/log/reading/log_contents.hpp"
#include "experiments/mujoco/motions.hpp"

namespace hagfish {

/// The core held against MuJoCo: random states, rollouts by the same rule, errors over the step.
/// Bounds stand beside their numbers in `h5`, NAME and NAME_bound. False where a difference is
/// beyond its bound.
bool compare(const ResolvedScene& resolved, Hdf5Writer& h5);

/// Error against CPU time of the core's and MuJoCo's steps along a smooth motion. False, with a
/// line on standard error, where the reference blows up.
bool integrate(const ResolvedScene& resolved, const Motion& motion, Hdf5Writer& h5);

/// The slide of a log in MuJoCo under f_thigmo alone, the log's mean from frame to frame. Throws
/// FileError where the knot of the log does not slide for two frames, or where intervals between
/// restarts are no whole frames.
void playback(const LogContents& log, Hdf5Writer& h5);

}  // namespace hagfish
