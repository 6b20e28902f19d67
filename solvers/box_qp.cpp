#include "solvers/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/free_rows.hpp"
#include "solvers/ipopt_box_qp.hpp"

namespace hagfish {

const char* status_name(SolveStatus status) {
  switch (status) {
    case SolveStatus::solved:
      return "solved";
    case SolveStatus::infeasible:
      return "infeasible";
    case SolveStatus::iteration_limit:
      return "iteration limit";
    case SolveStatus::failed:
      break;
  }
  return "failed";
}

void check_box_qp(const BoxQp& qp) {
  const Eigen::Index m = qp.b.size();
  if (qp.A.rows() != m || qp.A.cols() != m || qp.lower.size() != m || qp.upper.size() != m) {
    throw std::invalid_argument("box QP: A, b, lower and upper differ in size");
  }
  if (!qp.A.allFinite() || !qp.b.allFinite()) {
    throw std::invalid_argument("box QP: A or b is not finite");
  }
  if (!((qp.lower.array() <= 0).all() && (qp.upper.array() >= 0).all())) {
    throw std::invalid_argument("box QP: bounds leave out 0");
  }
}

Eigen::VectorXd row_scale(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd s = A.diagonal().cwiseMax(0).cwiseSqrt();
  const double largest = s.size() > 0 ? s.maxCoeff() : 0;
  return s.cwiseMax(largest > 0 ? 1e-10 * largest : 1.0);
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x) {
  return kkt_residuals(qp, x, qp.A * x - qp.b);
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x, const Eigen::VectorXd& w) {
  KktResiduals r;
  if (x.size() == 0) {
    return r;
  }
  if (!x.allFinite() || !w.allFinite()) {
    r.primal = std::numeric_limits<double>::infinity();
    return r;
  }
  const Eigen::VectorXd s = row_scale(qp.A);
  double beta = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::sqrt(qp.A(i, i)) >= s[i]) {  // not at the floor of row_scale
      beta = std::max(beta, std::abs(qp.b[i]) / s[i]);
    }
  }
  beta = beta > 0 ? beta : 1;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double wi = w[i] / s[i] / beta;
    const double above = (x[i] - qp.lower[i]) * s[i] / beta;  // room to the bounds, inf where free
    const double below = (qp.upper[i] - x[i]) * s[i] / beta;
    const double room = wi > 0 ? above : below;
    if (std::isinf(room)) {
      r.primal = std::max(r.primal, std::abs(wi));
    } else {
      r.complementarity = std::max(r.complementarity, std::abs(wi) * std::max(room, 0.0));
    }
    r.primal = std::max({r.primal, -above, -below});
  }
  return r;
}

std::vector<std::string> box_qp_solver_names() { return {"ipopt"}; }

std::unique_ptr<BoxQpSolver> make_box_qp_solver(const std::string& name) {
  if (name == "ipopt") {
    return std::make_unique<IpoptBoxQp>();
  }
  throw std::invalid_argument("unknown QP back end '" + name + "' (there is: ipopt)");
}

BoxQpSolution solve_bilateral(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  BoxQpSolution solution;
  if (b.size() == 0) {
    solution.status = SolveStatus::solved;
    return solution;
  }
  const SemidefiniteFactor factor(A);
  solution.x = factor.solve(b);
  solution.iterations = 1;
  solution.status = factor.meets(solution.x, b) ? SolveStatus::solved : SolveStatus::infeasible;
  return solution;
}

}  // namespace hagfish
