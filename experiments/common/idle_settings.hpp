// Settings that would be recorded and do nothing.
#pragma once

#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace hagfish {

/// Throws InputError, naming the key, where one of `set` (KEY=VALUE) cannot act in `scene`: seeds
/// without noise, speeds of a law that asks for none, settings of another law or of what is not
/// there.
void require_settings_act(const Scene& scene, const std::vector<std::string>& set);

/// Requires this of a sweep: of its settings and of the keys of its axes. None of them may be idle
/// in all of `scenes`, which have the values of each axis, of seeds one.
void require_settings_act_somewhere(const std::vector<Scene>& scenes,
                                    const std::vector<std::string>& set);

/// Requires this of a run that goes on from `sim` in `scene`: what only its start or a phase that
/// is over reads cannot act.
void require_settings_act_from(const Simulation& sim, const Scene& scene,
                               const std::vector<std::string>& set);

}  // namespace hagfish
