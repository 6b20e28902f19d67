// A set of rows as the box QP in their multipliers: A = C H⁻¹ C', b = d - C q̇*.
#pragma once

#include <vector>

#include "core/articulated.hpp"
#include "core/rows.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Storage that assemble_dual keeps from call to call.
struct DualScratch {
  RowColumns columns;
  Columns product;
};

/// The problem on `rows` (m): `factor` of H, `unconstrained` the velocity q̇* (nv) with the body
/// twists (6 x N) that go with it.
void assemble_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                   const std::vector<Row>& rows, const Eigen::VectorXd& unconstrained,
                   const Matrix6Xd& twist, DualScratch& scratch, BoxQp& qp);

}  // namespace hagfish
