// What the datasets of a log must be before any of their numbers is used: the log may come from
// anywhere.
#pragma once

#include "core/chain/model.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Whether the last frame is the state at the run's end, behind all of /steps; false of a log
/// without these.
bool ends_with_end_frame(const Hdf5Reader& log);

/// What every reader of a log relies on; throws FileError naming the first dataset that is not so.
/// First, nothing of it read: those that all commands use are there, all that are there (older logs
/// have fewer) have type and shape of `model`, and together they fit into the memory of this
/// machine. Then the values: times rise, steps go up by the scene's stride from 0 or later, but for
/// the state at the end, and are covered by /steps, phases, bodies, frames and kinds of solve
/// exist, positions and velocities are finite and not absurd.
void check_schema(const Hdf5Reader& log, const Model& model, const Scene& scene);

}  // namespace hagfish
