// The state with which a run ends, as the last frame of its log.
#pragma once

#include "core/run/simulation.hpp"

namespace hagfish {

/// No step begins at a run's end: all that would be of it is nan, and it has no rows. Phase and
/// clamp are those of the last step; contacts, energy and momentum are of the state.
StepRecord end_record(const Model& model, double time, const Simulation& sim, bool clamped);

}  // namespace hagfish
