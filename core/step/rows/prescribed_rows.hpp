// Rows whose velocities are prescribed, so that they cost nothing in the QP: those of the head
// clamp, and limits that pushed in the last step. The choice of limits affects speed alone. A limit
// that would have to pull is released, and the step is solved again. Over the Table 1 run the clamp
// saves 6 % of the CPU time, and the limits another 5 %. Limits that have just begun to push are
// included. At 100 bodies this gains nothing; at 400 it gains a fifth of a sliding step's time.
#pragma once

#include <vector>

#include "core/step/step_solution.hpp"
#include "core/step/warm_start.hpp"

namespace hagfish {

/// Marks the rows to prescribe.
void prescribe_rows(const WarmStart& warm, std::vector<Row>& rows);

/// The velocities that the first `step.prescribed` rows prescribe, by rising dof.
void prescribed_velocities(const StepSolution& step, std::vector<PrescribedVelocity>& velocities);

/// Releases all prescribed rows. Returns whether there were any.
bool release_all(StepSolution& step);

/// Releases prescribed limits with λ < 0. Returns whether there were any.
bool release_pulling(StepSolution& step);

}  // namespace hagfish
