// Impacts of a step of the midpoint rule, and the velocity after it (core/README.md, "Steps in
// time").
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// Computes step.next and the impacts of step.rows, for a step that is solved at `place` by
/// `problem`. Writes into `half_change` (nv) half of the change of velocity by steady forces. Not
/// ok (non_finite) where a prescribed limit cannot be released.
Status set_next_velocity(const StepInput& in, const StepPlace& place, const RowProblem& problem,
                         StepSolution& step, Eigen::VectorXd& half_change);

}  // namespace hagfish
