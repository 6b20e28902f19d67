// Error against CPU time of the core's and MuJoCo's steps along a smooth motion.
#pragma once

#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"
#include "experiments/mujoco/motions.hpp"

namespace hagfish {

/// Prints a table and leaves what it is made of in `h5`. False, with a line on standard error,
/// where the reference blows up.
bool integrate(const ResolvedScene& resolved, const Motion& motion, Hdf5Writer& h5);

}  // namespace hagfish
