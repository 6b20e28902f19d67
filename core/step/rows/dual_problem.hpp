// A set of rows as the box QP in their multipliers: A = C H⁻¹ C' + the compliance
// of flesh on the diagonal, b = d - C q̇*.
#pragma once

#include <span>

#include "core/chain/articulated.hpp"
#include "core/chain/dynamics.hpp"
#include "core/step/rows/row.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// The problem on `rows` (m). `factor` is that of H. `base` is the velocity q̇* without the forces
/// of these rows (nv), and `bodies` has the motion of the bodies at it. `columns` is storage.
void assemble_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                   std::span<const Row> rows, const Eigen::VectorXd& base,
                   const BodyVelocities& bodies, RowColumns& columns, BoxQp& qp);

/// The problem of a step on all of `rows`, from Eq. 1 as assembled. No row is prescribed.
BoxQp whole_dual(const Model& model, const Kinematics& kin, const StepSystem& system,
                 std::span<const Row> rows);

}  // namespace hagfish
