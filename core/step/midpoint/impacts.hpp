// Impacts of a step of the midpoint rule, and the velocity after it (core/README.md, "Steps in
// time").
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// step.next and the impacts of step.rows, of a step that is solved at `place` by `problem`; half
/// of what steady forces change the velocity by in it into `half_change` (nv). Not ok (non_finite)
/// where a prescribed limit cannot be let go.
Status set_next_velocity(const StepInput& in, const StepPlace& place, const RowProblem& problem,
                         StepSolution& step, Eigen::VectorXd& half_change);

}  // namespace hagfish
