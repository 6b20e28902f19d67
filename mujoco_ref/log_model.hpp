// A log's own model in MuJoCo, and whether a MuJoCo model is the core's.
#pragma once

#include <string>

#include "core/chain/model.hpp"
#include "core/log/hdf5_reader.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// The model that a log carries under /mjcf; rows of its /trajectory/q are MuJoCo's qpos. Throws
/// FileError, one line with the log's name, where the log holds none, one that asks for more than
/// models of this program have (mjcf_vocabulary.hpp), or one that MuJoCo rejects.
MujocoModel mujoco_model_of(const Hdf5Reader& log);

/// The first quantity in which `mirror`, with a free head, is not `model` at timestep `h` (s), with
/// both values: "mass of b17: 0.81 against 0.8 g". Empty where all agree to 1e-12 of each value;
/// MJCF carries all digits. Looks at counts, names, timestep, gravity, bodies, skin and joints;
/// cones are in no MuJoCo model.
std::string first_difference(const mjModel& mirror, const Model& model, double h);

}  // namespace hagfish
