// The step's operator H = J' Î J + diag(δ) of a chain, never formed: an articulated-body
// factorisation applies H⁻¹ in O(n) to many right-hand sides at once (Featherstone 2008, ch. 7).
// Spatial vectors are in world axes about one point (core/spatial.hpp), so the recursion has no
// transforms, and joints of several dofs are taken as one dof after another.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/kinematics.hpp"
#include "core/model.hpp"

namespace hagfish {

struct Operator {
  std::vector<Matrix6d> inertia;  ///< Î, one symmetric positive operator per body, about O
  Eigen::VectorXd diagonal;       ///< δ >= 0, nv
};

/// H v in O(n).
Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const Operator& op,
                         const Eigen::VectorXd& v);

/// Lower and upper triangle of H, dense nv x nv (composite rigid bodies; with Î the bodies'
/// inertias and δ = 0 this is the mass matrix M).
Eigen::MatrixXd dense(const Model& model, const Kinematics& kin, const Operator& op);

/// Row-major, so that one operation on a row serves all right-hand sides.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// m right-hand sides r = J' w + τ, or their m solutions with the body twists that go with them.
struct ColumnSet {
  Columns joint;  ///< nv x m: τ in, H⁻¹ r out
  Columns body;   ///< 6 N x m: w (6 rows a body, wrenches about O) in, twists out
};

class ArticulatedFactor {
 public:
  /// Throws std::domain_error, naming the dof, where H is not positive definite.
  void factorise(const Model& model, const Kinematics& kin, const Operator& op);

  /// Replaces right-hand sides by solutions, in place.
  void solve(const Model& model, const Kinematics& kin, ColumnSet& columns) const;

  /// H⁻¹ (J' w + τ) for one wrench per body (6 x N) and joint forces τ (nv).
  Eigen::VectorXd solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                        const Eigen::VectorXd& joint) const;

 private:
  Matrix6Xd weighted_;             // Î^A S, one column a dof
  Eigen::VectorXd inverse_pivot_;  // 1 / (S' Î^A S + δ)
};

}  // namespace hagfish
