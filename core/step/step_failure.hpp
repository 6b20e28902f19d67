// Why a step's problem could not be solved, in words.
#pragma once

#include <vector>

#include "core/step/outcome.hpp"
#include "core/step/rows/row.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// The status of `solution`, a back end's failed answer to `qp`, the problem on `rows`. It names
/// the rows that contradict each other, which the active-set method finds if the back end did not.
/// Without such rows it names the row with the largest violation.
Status describe_failure(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                        const BoxQpSolution& solution);

}  // namespace hagfish
