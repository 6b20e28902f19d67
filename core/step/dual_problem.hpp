// A set of rows as the box QP in their multipliers: A = C H⁻¹ C', b = d - C q̇*.
#pragma once

#include <span>

#include "core/chain/articulated.hpp"
#include "core/chain/dynamics.hpp"
#include "core/step/rows.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// The problem on `rows` (m): `factor` of H, `base` the velocity q̇* without their forces (nv),
/// by which the bodies move as `bodies` says. `columns` is storage.
void assemble_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                   std::span<const Row> rows, const Eigen::VectorXd& base,
                   const BodyVelocities& bodies, RowColumns& columns, BoxQp& qp);

/// How the problem on some rows changes by further ones, of the same factor.
struct DualExtension {
  BoxQp qp;  ///< on the rows that there were, those added and those released
  RowColumns columns;
  Eigen::VectorXd reaction;  ///< λ of the released rows in the base motion
  Eigen::MatrixXd cross, own, answer;
  Eigen::MatrixXd inertia;  ///< of the released velocities, overwritten by its factor
};

/// Rows of one problem, in its order: those there were, those added to them, and unit rows of
/// velocities that `factor` has as prescribed and that are released.
struct ExtendedRows {
  std::span<const Row> there, added, released;
};

/// Extends `qp`, which assemble_dual made of rows.there, without a new factorisation: to velocities
/// that are released H⁻¹ answers by the inertia that they have with the others free (a principal
/// pivot). extension.reaction is set; other arguments as for assemble_dual, and `columns` as it
/// left them.
void extend_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                 const ExtendedRows& rows, const Eigen::VectorXd& base,
                 const BodyVelocities& bodies, const RowColumns& columns, const BoxQp& qp,
                 DualExtension& extension);

/// The problem of a step on all of `rows`, with nothing prescribed, from Eq. 1 as assembled.
BoxQp whole_dual(const Model& model, const Kinematics& kin, const StepSystem& system,
                 std::span<const Row> rows);

}  // namespace hagfish
