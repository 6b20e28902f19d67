// A step that is solved and not taken. By it a control law sees what the paper's law would do.
#pragma once

#include "core/control/control_law.hpp"
#include "core/step/step.hpp"

namespace hagfish {

/// Storage of such a step, which is allocated once.
struct UntakenStep {
  Control control;  ///< control of the step
  StepSolver solver{"active-set"};
  StepSolution step;
};

/// Begins the step of `scene` from the state of `at` by `untaken.control`. It has no warm start, so
/// that it depends on these alone. Throws StepError if the step cannot be solved.
void begin_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken);

/// Solves the step to its end, with the forces of all rows.
void solve_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken);

}  // namespace hagfish
