// A run as a stream: steps one after the other, and who watches them.
#pragma once

#include <functional>
#include <initializer_list>

#include "core/run/simulation.hpp"

namespace hagfish {

/// Sees a step of a run, and where it led. It changes neither.
using Watcher = std::function<void(const StepRecord& record, const Simulation& sim)>;
/// Asked before each step: whether the run ends here.
using Stop = std::function<bool()>;
/// Takes one step of a run, as take_step does.
using TakeStep = std::function<void(Simulation& sim, StepRecord& record)>;

/// Takes steps of `sim` until the scene is over, `stop` says so, or a step cannot be taken. Says
/// which: Outcome::ok, Outcome::stopped, or what the step's StepError has. After a failure `record`
/// has what take_step leaves there. Other exceptions go through.
Status drive(const Scene& scene, const TakeStep& take, Simulation& sim, StepRecord& record,
             std::initializer_list<Watcher> watchers, const Stop& stop = {});
/// Drives by take_step.
Status drive(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record,
             std::initializer_list<Watcher> watchers, const Stop& stop = {});

}  // namespace hagfish
