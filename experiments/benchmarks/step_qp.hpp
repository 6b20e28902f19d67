// The QP of a step, taken out of a run: whole, with the prescribed rows.
#pragma once

#include <Eigen/Core>

#include "core/run/simulation.hpp"
#include "core/step/paper_step.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

/// Whether the step had rows that may bind or not; else it is Eq. 1 or 3.
bool has_qp(const StepSolution& solution);

/// Whether a soft row's multiplier is at its upper bound: Eq. 4 with that row hard has another
/// solution then, and else the same.
bool at_cap(const StepSolution& solution);

/// The QP as the paper's Eq. 4 has it, with soft rows as hard ones: H and g dense in q̇, bilateral
/// rows in G and e, all others in C and d, in the order of record.solution.rows.
PrimalQp to_primal(const Model& model, const Scene& scene, const StepRecord& record);

/// What `warm`, as the step found it, keeps of the multipliers of its rows; 0 where nothing.
Eigen::VectorXd kept_multipliers(const std::vector<Row>& rows, const WarmStart& warm);

}  // namespace hagfish
