// One cell of the failure map: a scene run by one method.
#pragma once

#include <string>
#include <vector>

#include "core/step/outcome.hpp"
#include "experiments/mujoco/stress_judge.hpp"

namespace hagfish {

/// Ways to take a cell's steps, by name.
std::vector<std::string> stress_methods();

/// What a method at a time step (s; 0: the scene's) changes of the scene, KEY=VALUE. This and
/// stress() throw std::invalid_argument where `method` is none of stress_methods().
std::vector<std::string> stress_overrides(const std::string& method, double step);

/// What became of a cell.
struct StressResult {
  Status status;
  StressFigures figures;
  double cpu_time = 0;  ///< s
};

/// Runs `scene`, which has the method's overrides, with the model made of it. A run that takes
/// longer than `cpu_limit` (s) ends there, Outcome::capped.
StressResult stress(const Scene& scene, const Model& model, const std::string& method,
                    double cpu_limit);

}  // namespace hagfish
