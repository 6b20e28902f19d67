// A step that is solved and not taken. By it a control law sees what the paper's law would do.
#pragma once

#include "core/control/control_law.hpp"
#include "core/step/step.hpp"

namespace hagfish {

/// Such a step, whose storage is allocated once.
struct UntakenStep {
  Control control;  ///< control of the step
  StepSolver solver{"active-set"};
  StepSolution step;

  /// Begins the step of `scene` from the state of `at`. It has no warm start, so that it depends on
  /// these and `control` alone. Throws StepError if the step cannot be solved.
  void begin(const Situation& at, const Scene& scene);
  /// Solves the step to its end, with the forces of all rows. Throws as begin() does.
  void solve(const Situation& at, const Scene& scene);
};

}  // namespace hagfish
