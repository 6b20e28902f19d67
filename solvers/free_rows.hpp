// Exact elimination of the free (bilateral) rows of a box QP.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "solvers/box_qp.hpp"

namespace hagfish {

/// A x = b for a symmetric positive semidefinite A (m x m): rows brought to unit diagonal, then a
/// rank-revealing factorisation. Redundant rows share their force (least norm after scaling).
class SemidefiniteFactor {
 public:
  explicit SemidefiniteFactor(const Eigen::MatrixXd& A);
  /// `b` is m x k; a least-squares answer where the columns are not consistent.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// Whether A x = b (m) is met by `x` to rounding, of which b may bring some of its own (m); false
  /// where rows contradict each other.
  bool meets(const Eigen::VectorXd& x, const Eigen::VectorXd& b,
             const Eigen::VectorXd& rounding) const;

 private:
  Eigen::VectorXd inverse_scale_;
  Eigen::MatrixXd scaled_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor_;
};

/// What is left of a box QP once rows without any choice are taken out: free rows by Schur
/// complement, and rows that cannot move at zero (lower = upper), or with no diagonal left at zero
/// or the bound that they are pushed to. Interior points need it: a clamp's multipliers are
/// thousands of times larger than the rest.
class BoundedPart {
 public:
  explicit BoundedPart(const BoxQp& qp);
  /// False where free rows contradict each other, or a row that cannot move would have to and has
  /// no bound that way.
  bool consistent() const { return consistent_; }
  const BoxQp& reduced() const { return reduced_; }
  /// Entries of a full vector (m) that belong to the reduced problem.
  Eigen::VectorXd restrict_to_reduced(const Eigen::VectorXd& full) const { return full(kept_); }
  /// The full x (m) from a reduced one.
  Eigen::VectorXd expand(const Eigen::VectorXd& reduced_x) const;

 private:
  Eigen::Index size_;
  BoxQp reduced_;
  std::vector<Eigen::Index> free_, kept_;
  Eigen::VectorXd left_out_;       ///< x of rows that are neither free nor kept, m
  Eigen::VectorXd free_at_zero_;   ///< free rows' x where every kept row is zero
  Eigen::MatrixXd free_response_;  ///< its change with each kept row's x
  bool consistent_ = true;
};

}  // namespace hagfish
