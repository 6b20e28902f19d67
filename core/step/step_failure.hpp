// Why a step's problem could not be solved, in words.
#pragma once

#include <vector>

#include "core/step/outcome.hpp"
#include "core/step/rows.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// `solution` is a back end's failed answer to `qp`, the problem on `rows`. Names the rows that
/// contradict each other, which the active-set method finds where that back end did not; without
/// such rows, the one furthest from being met.
Status describe_failure(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                        const BoxQpSolution& solution);

}  // namespace hagfish
