// The paper's Eq. 4 as it stands, on dense matrices.
#pragma once

#include <Eigen/Core>

#include "solvers/box_qp.hpp"

namespace hagfish {

/// min ½ v' H v - g' v  subject to  G v = e, C v >= d. A row of C with a finite `cap` is soft: its
/// slack s >= 0 in C v + s >= d costs cap s, which bounds its multiplier by cap.
struct PrimalQp {
  Eigen::MatrixXd H;    ///< n x n, symmetric, positive definite
  Eigen::VectorXd g;    ///< n
  Eigen::MatrixXd G;    ///< p x n, independent rows; p may be 0
  Eigen::VectorXd e;    ///< p
  Eigen::MatrixXd C;    ///< m x n; m may be 0
  Eigen::VectorXd d;    ///< m
  Eigen::VectorXd cap;  ///< m, >= 0, +infinity where the row is hard
};

/// Throws std::invalid_argument where sizes differ.
void check_primal_qp(const PrimalQp& qp);

/// [G; C], (p + m) x n.
Eigen::MatrixXd all_rows(const PrimalQp& qp);

/// The dual problem, in the multipliers, rows of G first: A = [G; C] H⁻¹ [G; C]' by a dense
/// Cholesky factorisation, and the rounding of b, which is a difference. Throws
/// std::invalid_argument where H is not positive definite.
BoxQp dual_of(const PrimalQp& qp);

}  // namespace hagfish
