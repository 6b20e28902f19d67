#include "solvers/active_set.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hagfish {
namespace {

/// Largest kkt_residuals of a point that is called solved, as for Ipopt: far above rounding, which
/// is 1e-16 to 1e-12 with the size of x, and above what rows may miss that contradict each other by
/// rounding.
constexpr double accepted = 1e-8;

std::string names(const std::vector<Eigen::Index>& rows) {
  std::string text = rows.size() == 1 ? "row cannot be met: " : "rows contradict each other: ";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    text += (k == 0 ? "" : ", ") + std::to_string(rows[k]);
  }
  return text;
}

}  // namespace

void ActiveSetBoxQp::solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) {
  check_box_qp(qp);
  const Eigen::Index m = qp.b.size();
  if (start.size() != m) {
    throw std::invalid_argument("box QP: start differs in size from the problem");
  }
  pivoting_.start(qp);
  for (Eigen::Index i = 0; i < m; ++i) {
    const bool is_free = std::isinf(qp.lower[i]) && std::isinf(qp.upper[i]);
    if (start[i] <= qp.lower[i] && std::isfinite(qp.lower[i])) {
      pivoting_.fix(i, qp.lower[i]);
    } else if (start[i] >= qp.upper[i] && std::isfinite(qp.upper[i])) {
      pivoting_.fix(i, qp.upper[i]);
    } else if (is_free || start[i] != 0) {
      pivoting_.activate(i);
    }
  }
  ActiveSetPivoting::Ending ending = ActiveSetPivoting::Ending::settled;
  if (!pivoting_.change_blocks()) ending = pivoting_.change_singly();
  solution.message.clear();
  solution.contradicting.clear();
  solution.x = pivoting_.x();
  solution.iterations = pivoting_.changes();
  const bool settled = ending == ActiveSetPivoting::Ending::settled;
  const double residual = (settled ? kkt_residuals(qp, solution.x, pivoting_.w(), pivoting_.scale())
                                   : kkt_residuals(qp, solution.x))
                              .worst();
  if (ending == ActiveSetPivoting::Ending::contradiction) {
    solution.status = SolveStatus::infeasible;
    solution.contradicting = pivoting_.contradicting();
    solution.message = names(solution.contradicting);
  } else if (ending == ActiveSetPivoting::Ending::stopped) {
    solution.status = SolveStatus::stopped;
  } else if (residual <= accepted) {
    solution.status = SolveStatus::solved;
  } else {
    solution.status = ending == ActiveSetPivoting::Ending::limit ? SolveStatus::iteration_limit
                                                                 : SolveStatus::failed;
    std::ostringstream text;
    text << "KKT residual " << residual;
    solution.message = text.str();
  }
}

}  // namespace hagfish
