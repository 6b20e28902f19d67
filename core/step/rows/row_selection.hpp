// The rows of a step's problem: those near binding at first, violated ones later.
#pragma once

#include <vector>

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"
#include "core/step/warm_start.hpp"

namespace hagfish {

/// Writes into `rows` the rows of a step at `place` that are near binding at the last velocity:
/// head clamp, thigmotaxis, contacts, limits, obstacles. A pair of segments that is not a minimum
/// of the gap is among them if `warm` has a force of it from the last step.
void gather_rows(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                 std::vector<Row>& rows);

/// The row of `path_row` at `place`.
Row placed_row(const StepPlace& place, const PathRow& path_row);

/// Adds `row`, or replaces the row with the same id.
void put_row(const Row& row, std::vector<Row>& rows);

/// Writes into `rows` the unilateral rows that the velocity of `step` violates.
void gather_violated_rows(const StepInput& in, const StepPlace& place, const StepSolution& step,
                          std::vector<Row>& rows);

}  // namespace hagfish
