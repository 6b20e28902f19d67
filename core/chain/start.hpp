// The state that a scene starts from.
#pragma once

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The state of `settings`, whose q and qdot, where given, have the lengths nq and nv of `model`.
/// Bends and noise stop at the limits of the hinges or cones; a given q does not. The noise depends
/// on the seed and the number of hinges alone (on one standard library).
State start_state(const Model& model, const StartSettings& settings);

}  // namespace hagfish
