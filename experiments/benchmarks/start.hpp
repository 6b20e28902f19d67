// States with which the benchmarks begin: one animal, ready to step in both simulators.
#pragma once

#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/run/simulation.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// States of one animal, with a scene that lets it step on from each. Some steps have been taken to
/// them, so that the first one from there is as warm as MuJoCo's, which starts from accelerations
/// that it keeps.
struct Start {
  Scene scene;
  Model model;
  std::vector<Simulation> sims;  ///< runs with the active-set back end

  const Simulation& middle() const { return sims[sims.size() / 2]; }
};

/// Five states of a log, in the middles of as many equal parts of the slide: knotted and tight, the
/// head clamped, to go on by `rule`. Throws FileError where the log has no slide.
Start knotted_start(const std::string& log, TimeRule rule = TimeRule::euler);

/// The animal without contact: a gentle wave that stays clear of limits and of itself, slowly
/// moving, the head free.
Start free_start(const Start& knotted);

/// The mirror of `start`, in its middle state; the head is clamped where the core clamps it.
/// Contacts are MuJoCo's own, from touch on (margin 0).
MujocoModel mirror_of(const Start& start);

}  // namespace hagfish
