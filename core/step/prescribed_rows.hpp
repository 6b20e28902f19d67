// Rows whose velocities are prescribed, so that they cost nothing in the QP: those of the head
// clamp, and limits that pushed in the last step. Only speed depends on the choice of limits: one
// that would have to pull is released and the step is solved again. Measured over the Table 1 run:
// the clamp saves 6 %, the limits another 5 % of the CPU time; limits that had only begun to push
// are worth their releases, too: nothing at 100 bodies, a fifth of a sliding step's time at 400.
#pragma once

#include <vector>

#include "core/step/step_solution.hpp"
#include "core/step/warm_start.hpp"

namespace hagfish {

/// Marks the rows to prescribe.
void prescribe_rows(const WarmStart& warm, std::vector<Row>& rows);

/// The velocities that the first `step.prescribed` rows prescribe, by rising dof.
void prescribed_velocities(const StepSolution& step, std::vector<PrescribedVelocity>& velocities);

/// Releases all prescribed rows; whether there were any.
bool release_all(StepSolution& step);

/// Releases prescribed limits with λ < 0; whether there were any.
bool release_pulling(StepSolution& step);

}  // namespace hagfish
