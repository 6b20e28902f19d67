// The paper's step (3.1, Eqs. 1 to 4) on dense matrices and without regard to speed, with the
// implicit springs and the rows of this simulator. It is the reference for the simulator's step,
// and `hagfish record-qp --primal` records it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/step/step_input.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

/// J of one body, 6 x nv, about kin.reference (RedMax): the axes of the velocities of the joints
/// before it, and zeros for those behind it.
Matrix6Xd body_jacobian(const Model& model, const Kinematics& kin, int body);

/// Jacobian of a body's centre, 3 x nv.
Eigen::Matrix3Xd centre_jacobian(const Model& model, const Kinematics& kin, int body);

/// Rows as a dense matrix, m x nv.
Eigen::MatrixXd dense_rows(const Model& model, const Kinematics& kin, const std::vector<Row>& rows);

/// H and g of Eq. 1 at `place`; G, e, C and d of Eqs. 3 and 4 from `rows`, in their order. `cap`
/// has the upper bounds of the multipliers (soft rows, an addition to the paper). Behind v, rows of
/// flesh have a velocity each by which they yield.
PrimalQp paper_problem(const StepInput& in, const StepPlace& place, const std::vector<Row>& rows);

/// The step to the new state by Eq. 1, 3 or 4, whichever `rows` ask for, and Eq. 2. `solve` returns
/// v of Eq. 4 (nv).
State paper_step(const StepInput& in, const std::vector<Row>& rows,
                 const std::function<Eigen::VectorXd(const PrimalQp&)>& solve);

}  // namespace hagfish
