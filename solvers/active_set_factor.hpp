// Cholesky factor of the rows of an active set, changed a few rows at a time.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace hagfish {

/// L L' = S A(rows, rows) S for a symmetric positive semidefinite A (m x m) and a diagonal S that
/// brings rows to unit diagonal. Rows that depend on those already in are refused, so that the
/// block is always regular. Keeps its memory between problems; a reference to A and S from reset().
class ActiveSetFactor {
 public:
  /// Empties the block. `A` (m x m) and `inverse_scale` (m, the diagonal of S) must outlive the
  /// use.
  void reset(const Eigen::MatrixXd& A, const Eigen::Map<Eigen::VectorXd>& inverse_scale);

  /// Indices into A, in the order of the factor.
  const std::vector<Eigen::Index>& rows() const { return rows_; }
  bool contains(Eigen::Index row) const { return active_[row] != 0; }

  /// Adds `added` (none of them in) one after the other. Rows that depend on those before them to
  /// rounding (at least 1e-12 of their unit diagonal) stay out; true where there were none.
  bool append(std::span<const Eigen::Index> added) { return change({}, added); }

  /// Takes `dropped` (all of them in) out. What follows the first of them is factorised again.
  void remove(std::span<const Eigen::Index> dropped) { change(dropped, {}); }

  /// remove() and append() in one. A row of `added` may depend on one of `dropped`.
  bool change(std::span<const Eigen::Index> dropped, std::span<const Eigen::Index> added);

  /// y = A(rows, rows)⁻¹ c(rows), in the order of rows(); `c` has m entries. Valid until the next
  /// call.
  Eigen::Ref<const Eigen::VectorXd> solve(const Eigen::Ref<const Eigen::VectorXd>& c);

 private:
  double* column(Eigen::Index p, Eigen::Index k);
  bool factorise_from(Eigen::Index position);
  Eigen::Index make_panel(Eigen::Index p);
  void gather(Eigen::Index p);
  Eigen::Index make_diagonal(Eigen::Index p);
  bool accept(double pivot, Eigen::Index position);
  double pivot_rounding(Eigen::Index position);
  void solve_lower(Eigen::Index n);
  void solve_upper(Eigen::Index n);

  const Eigen::MatrixXd* A_ = nullptr;
  const Eigen::Map<Eigen::VectorXd>* inverse_scale_ = nullptr;
  /// The factor in panels of tile_rows rows, one behind the other, each by columns up to its
  /// diagonal tile. What lies above the diagonal in that tile means nothing.
  Eigen::VectorXd L_;
  Eigen::VectorXd inverse_pivot_;  ///< 1 / L_kk by position
  Eigen::VectorXd work_;
  Eigen::VectorXd sums_;  ///< storage of solve_upper: tile_rows for each position
  std::vector<Eigen::Index> rows_;
  std::vector<char> active_;
};

}  // namespace hagfish
