// A solver of the paper's Eq. 4 in its primal form: the reference for box_qp.hpp, with its own
// problem, scaling and stopping. Accuracy first, speed irrelevant.
#pragma once

#include "solvers/box_qp.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

struct PrimalQpSolution {
  Eigen::VectorXd v;       ///< n
  Eigen::VectorXd mu;      ///< p: H v - g - G' mu - C' lambda = 0
  Eigen::VectorXd lambda;  ///< m, 0 <= lambda <= cap
  SolveStatus status = SolveStatus::failed;
  /// Largest scaled error in stationarity, the rows and the products of multiplier and excess,
  /// measured outside of Ipopt on the problem with unit diagonal of H and unit rows.
  double residual = 0;
};

/// Throws std::invalid_argument where sizes differ.
PrimalQpSolution solve_primal(const PrimalQp& qp);

}  // namespace hagfish
