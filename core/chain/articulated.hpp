// The step's operator H = J' Î J + diag(δ) of a chain, never formed: an articulated-body
// factorisation applies H⁻¹ in O(n) to many right-hand sides at once (Featherstone 2008, ch. 7).
// Spatial vectors are in world axes about one point (core/chain/spatial.hpp), so the recursion has
// no transforms, and joints of several dofs are taken as one dof after another.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "solvers/tile_product.hpp"

namespace hagfish {

/// A symmetric operator on twists whose columns fill a vector register: two rows of 0 below.
struct PaddedOperator {
  PaddedOperator() = default;
  PaddedOperator(const Matrix6d& matrix) { columns.topRows<6>() = matrix; }  // NOLINT: the same
  auto matrix() { return columns.topRows<6>(); }
  auto matrix() const { return columns.topRows<6>(); }

  Eigen::Matrix<double, 8, 6> columns = Eigen::Matrix<double, 8, 6>::Zero();
};

struct StepOperator {
  std::vector<PaddedOperator> inertia;  ///< Î of each body about O, positive: g cm^2, g cm, g
  Eigen::VectorXd diagonal;             ///< δ >= 0, nv: g cm^2 for a turn, g for a translation
};

/// Writes H v into `product` (nv), an impulse, dyn s or dyn cm s, in O(n). `v` (nv) is laid out as
/// State::qdot, `twist` has the bodies' twists at v (6 x N), and `wrench` (6 x N) is storage.
void multiply(const Model& model, const Kinematics& kin, const StepOperator& op,
              const Eigen::VectorXd& v, const Matrix6Xd& twist, Matrix6Xd& wrench,
              Eigen::VectorXd& product);
Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const StepOperator& op,
                         const Eigen::VectorXd& v);

/// Lower and upper triangle of H, dense nv x nv, g, g cm and g cm² (composite rigid bodies). With Î
/// the bodies' inertias and δ = 0 this is the mass matrix M.
Eigen::MatrixXd dense(const Model& model, const Kinematics& kin, const StepOperator& op);

/// C' of m rows, column by column: joint forces and wrenches on single bodies, per unit λ; then Y
/// with Y'Y = C H⁻¹ C'. A column is zero beyond the last dof that moves its row. Panels of 8 are
/// processed to their longest column: order rows by falling last dof.
class RowColumns {
 public:
  /// Empties all for `m` columns.
  void reset(const Model& model, Eigen::Index m);
  /// Adds a wrench on one body to a column, in world axes: a moment about O, cm, and a force, 1.
  void load(const Model& model, int body, Eigen::Index column, const Eigen::Vector3d& moment,
            const Eigen::Vector3d& force);
  /// Adds a force (1) on one velocity to a column.
  void load_joint(Eigen::Index dof, Eigen::Index column, double force);
  /// A = Y'Y, m x m, after half_solve: rates of rows per unit λ. Symmetric and semidefinite.
  void gram(Eigen::MatrixXd& A) const;

 private:
  friend class ArticulatedFactor;
  static constexpr int panel = tile_rows;
  struct Load {
    Eigen::Vector3d moment, force;
    Eigen::Index column;
    int next;  ///< load of the same body, -1 at the end
  };
  struct JointLoad {
    double force;
    Eigen::Index column;
    int next;  ///< load of the same velocity, -1 at the end
  };
  void extend(Eigen::Index column, Eigen::Index end);
  void set_widths();

  Eigen::Index count_ = 0;
  std::vector<Load> loads_;
  std::vector<JointLoad> joint_loads_;
  std::vector<int> newest_, newest_joint_;  ///< load of each body, velocity; -1 where it has none
  std::vector<Eigen::Index> end_;           ///< 1 + the last velocity of each panel
  std::vector<Eigen::Index> width_;         ///< panels times columns that reach each velocity
  /// Y, nv x m' with m' >= m, row-major so that one operation serves all columns. Rows past the end
  /// of a panel are not set.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y_;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> sum_;
};

/// A velocity that is prescribed, rad/s or cm/s: that of a joint that rests on its limit, say.
struct PrescribedVelocity {
  int dof = 0;
  double value = 0;
};

/// H⁻¹ of the velocities that are not prescribed; those that are cost nothing (hybrid dynamics,
/// Featherstone 2008, ch. 9.2).
class ArticulatedFactor {
 public:
  /// Factorises H of `op` in the pose of `kin`. `prescribed` is by rising dof, once each. Throws
  /// std::domain_error, naming the dof, where H is not positive definite.
  void factorise(const Model& model, const Kinematics& kin, const StepOperator& op,
                 std::span<const PrescribedVelocity> prescribed = {});

  /// Solves H v = J' w + τ + the reactions of prescribed velocities. `wrench` has w, an impulse on
  /// each body about O (6 x N, dyn cm s and dyn s). `joint` has τ (nv, dyn cm s or dyn s). Writes
  /// `v` (nv, as State::qdot), the bodies' twists at it (6 x N), and `reaction`, the impulse at
  /// each prescribed velocity.
  void solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
             const Eigen::VectorXd& joint, Eigen::VectorXd& v, Matrix6Xd& twist,
             Eigen::VectorXd& reaction) const;
  Eigen::VectorXd solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                        const Eigen::VectorXd& joint) const;
  /// Solves this with the values of `prescribed`, whose dofs are those of the factorisation.
  void solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
             const Eigen::VectorXd& joint, std::span<const PrescribedVelocity> prescribed,
             Eigen::VectorXd& v, Matrix6Xd& twist, Eigen::VectorXd& reaction) const;

  /// Turns C' in `columns` into Y: half of a solve, since the recursion factors H⁻¹ = L'L.
  /// Prescribed velocities do not answer to a force.
  void half_solve(const Model& model, const Kinematics& kin, RowColumns& columns) const;

  /// S' Î^A S + δ, g or g cm²: impulse over velocity at a dof (prescribed or not) where all nearer
  /// the head are prescribed.
  double pivot(int dof) const { return pivot_[dof]; }

 private:
  Matrix6Xd weighted_;             // Î^A S, one column a dof
  Eigen::VectorXd coupling_;       // S' Î^A S of each dof and the one before it
  Eigen::VectorXd pivot_;          // S' Î^A S + δ
  Eigen::VectorXd inverse_pivot_;  // 0 where prescribed
  std::vector<PrescribedVelocity> prescribed_;
};

}  // namespace hagfish
