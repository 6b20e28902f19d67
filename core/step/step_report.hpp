// Forces and residuals of a solved step.
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// Storage of the functions below.
struct ReportStorage {
  Eigen::VectorXd row_scale;  ///< scales rows to unit diagonal
  Eigen::VectorXd scaled;     ///< |λ| of the scaled rows
  Matrix6Xd wrench;
  Eigen::VectorXd joint, impulse, change;
};

/// Computes the excess C q̇ - d of the rows of `step`, and the residuals of Eq. 4, which is
/// `problem`.
void measure_rows(const RowProblem& problem, ReportStorage& storage, StepSolution& step);

/// Keeps the multipliers of all rows with a force for the next step. Call it after measure_rows.
void keep_active(const ReportStorage& storage, const StepSolution& step, WarmStart& warm);

/// Computes the forces of rows, tip and muscles, and their difference from the forces that the
/// motion needs, once the time rule has ended the step.
void report_forces(const StepInput& in, const StepPlace& place, ReportStorage& storage,
                   StepSolution& step);

}  // namespace hagfish
