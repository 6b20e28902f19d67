// A scene, its model and a simulation in it, step by step.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/run/simulation.hpp"
#include "experiments/common/scene_argument.hpp"

namespace hagfish {

/// A run of a scene by the active-set method. Tests change what is in it as they need.
struct SceneRun : ResolvedScene {
  SceneRun(ResolvedScene of)
      : ResolvedScene(std::move(of)), sim(start(model, scene, "active-set")) {}
  /// Of a built-in scene's name or a file, with KEY=VALUE overrides.
  explicit SceneRun(const std::string& name, const std::vector<std::string>& set = {})
      : SceneRun(scene_argument(name, set)) {}
  /// Of an animal in a scene made by hand.
  SceneRun(const Specimen& animal, const Scene& in)
      : SceneRun(ResolvedScene{in, animal, make_hagfish(animal, in)}) {}

  /// The step's record, which the next one overwrites. Throws as take_step does.
  const StepRecord& step() {
    take_step(model, scene, sim, record);
    return record;
  }
  double time() const { return time_of(sim, scene); }  ///< s
  Phase phase() const { return sim.controller.phase; }
  bool over() const { return finished(sim, scene); }

  Simulation sim;
  StepRecord record;
};

}  // namespace hagfish
