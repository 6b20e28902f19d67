// A set of rows as the box QP in their multipliers: A = C H⁻¹ C', b = d - C q̇*.
#pragma once

#include <vector>

#include "core/articulated.hpp"
#include "core/rows.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// One step's dual operator. Keeps references to its arguments: they must outlive it.
class DualProblem {
 public:
  /// `factor` of H, `unconstrained` the velocity q̇* (nv).
  DualProblem(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
              const Eigen::VectorXd& unconstrained);

  /// C q̇* - d of one row, cm/s or rad/s.
  double excess_unconstrained(const Row& row) const;

  /// The problem on `rows`: one solve with H for all of them, A read off the body twists.
  BoxQp assemble(const std::vector<Row>& rows) const;

 private:
  const Model& model_;
  const Kinematics& kin_;
  const ArticulatedFactor& factor_;
  const Eigen::VectorXd& unconstrained_;
  Matrix6Xd twist_;
};

}  // namespace hagfish
