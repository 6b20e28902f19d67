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

/// H v in O(n); `scratch` is storage.
void multiply(const Model& model, const Kinematics& kin, const Operator& op,
              const Eigen::VectorXd& v, Matrix6Xd& scratch, Eigen::VectorXd& product);
Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const Operator& op,
                         const Eigen::VectorXd& v);

/// Lower and upper triangle of H, dense nv x nv (composite rigid bodies; with Î the bodies'
/// inertias and δ = 0 this is the mass matrix M).
Eigen::MatrixXd dense(const Model& model, const Kinematics& kin, const Operator& op);

/// Row-major, so that one operation on a row serves all columns.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// C' of m rows, column by column: joint forces and wrenches on single bodies.
struct RowColumns {
  Columns joint;  ///< nv x m' with m' >= m: columns past m are zero and fill the last panel

  /// Empties all for `m` columns.
  void reset(const Model& model, Eigen::Index m);
  /// Adds a wrench about O on one body to a column.
  void load(int body, Eigen::Index column, const Vector6d& wrench);

 private:
  friend class ArticulatedFactor;
  static constexpr int panel = 8;
  struct Load {
    Vector6d wrench;
    Eigen::Index column;
    int next;  ///< load of the same body, -1 at the end
  };
  std::vector<Load> loads_;
  std::vector<int> newest_;  ///< load of each body, -1 where it has none
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> sum_;
};

class ArticulatedFactor {
 public:
  /// Throws std::domain_error, naming the dof, where H is not positive definite.
  void factorise(const Model& model, const Kinematics& kin, const Operator& op);

  /// v = H⁻¹ (J' w + τ) for one wrench per body (6 x N) and joint forces τ (nv).
  void solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
             const Eigen::VectorXd& joint, Eigen::VectorXd& v) const;
  Eigen::VectorXd solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                        const Eigen::VectorXd& joint) const;

  /// Replaces C' in columns.joint by Y (nv x m) with Y'Y = C H⁻¹ C': half of a solve, since the
  /// recursion factors H⁻¹ = L'L. The product is symmetric and semidefinite by construction.
  void half_solve(const Model& model, const Kinematics& kin, RowColumns& columns) const;

 private:
  Matrix6Xd weighted_;             // Î^A S, one column a dof
  Eigen::VectorXd inverse_pivot_;  // 1 / (S' Î^A S + δ)
};

}  // namespace hagfish
