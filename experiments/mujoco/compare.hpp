// The core held against MuJoCo: random states, rollouts by the same rule, errors over the step.
#pragma once

#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"

namespace hagfish {

/// Prints a table and leaves what it is made of in `h5`; bounds stand beside their numbers, NAME
/// and NAME_bound. False where a difference is beyond its bound.
bool compare(const ResolvedScene& resolved, Hdf5Writer& h5);

}  // namespace hagfish
