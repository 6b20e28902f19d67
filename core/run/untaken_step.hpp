// A step that is solved and not taken: by it a control law sees what the paper's law would do.
#pragma once

#include "core/run/control_law.hpp"
#include "core/step/step.hpp"

namespace hagfish {

/// Storage of it, which grows to size once.
struct UntakenStep {
  Control control;  ///< what it shall do
  StepSolver solver{"active-set"};
  StepSolution step;
};

/// Begins the step of `scene` from the state of `at` by `untaken.control`, from no warm start, so
/// that it follows from these alone. Throws StepError where it cannot be solved.
void begin_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken);

/// The same to its end, with the forces of all rows.
void solve_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken);

}  // namespace hagfish
