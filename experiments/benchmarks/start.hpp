// Where the benchmarks begin: states of one animal, ready to step in both simulators.
#pragma once

#include <string>

#include "core/input/scene_reader.hpp"
#include "core/run/simulation.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// One animal in one state, with a scene that lets it step on from there. Some steps have been
/// taken to it, so that the first one from it is as warm as MuJoCo's, which starts from
/// accelerations that it keeps.
struct Start {
  Scene scene;
  Model model;
  Simulation sim;  ///< with the active-set back end
};

/// The middle of the slide of a log: knotted and tight, the head clamped. Throws FileError where
/// the log has no slide.
Start knotted_start(const std::string& log);

/// The same animal without contact: a gentle wave that stays clear of limits and of itself, slowly
/// moving, the head free.
Start free_start(const Start& knotted);

/// The mirror of `start`, in its state; the head is clamped where the core clamps it. Contacts are
/// MuJoCo's own, from touch on (margin 0).
MujocoModel mirror_of(const Start& start);

}  // namespace hagfish
