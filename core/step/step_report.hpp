// What a solved step is reported by: forces and residuals.
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// Storage of the functions below.
struct ReportStorage {
  Eigen::VectorXd row_scale;  ///< what brings rows to unit diagonal
  Eigen::VectorXd scaled;     ///< |λ| of the rows so brought
  Matrix6Xd wrench;
  Eigen::VectorXd joint, impulse, change;
};

/// Excess C q̇ - d of the rows of `step`, and the residuals of Eq. 4, which `problem` has.
void measure_rows(const RowProblem& problem, ReportStorage& storage, StepSolution& step);

/// Keeps the multipliers of the rows with a force for the next step; after measure_rows.
void keep_active(const ReportStorage& storage, const StepSolution& step, WarmStart& warm);

/// Forces of the rows, tip and muscles, and how far they are from making the motion, once the time
/// rule has ended the step.
void report_forces(const StepInput& in, const StepPlace& place, ReportStorage& storage,
                   StepSolution& step);

}  // namespace hagfish
