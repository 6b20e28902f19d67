// An active set method for the box QP: pivoting on the rows of A with a Cholesky factor of the
// active ones. Exact to rounding, small and quick; the counterpart of Ipopt's interior point.
#pragma once

#include "solvers/active_set_pivoting.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Rows that `start` has off their bounds and off zero are tried as active first, in blocks; one
/// by one where blocks find no end. Keeps its memory from solve to solve. `iterations` counts
/// changes of the active set. Where rows contradict each other, `message` names them by index.
class ActiveSetBoxQp final : public BoxQpSolver {
 public:
  ActiveSetBoxQp() : pivoting_([this] { return stopped(); }) {}
  using BoxQpSolver::solve;
  void solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) override;

 private:
  ActiveSetPivoting pivoting_;
};

}  // namespace hagfish
