#include "solvers/box_qp.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

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

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x) {
  return kkt_residuals(qp, x, qp.A * x - qp.b);
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x, const Eigen::VectorXd& w) {
  KktResiduals r;
  if (x.size() == 0) {
    return r;
  }
  const Eigen::ArrayXd s = qp.A.diagonal().array().max(std::numeric_limits<double>::min()).sqrt();
  const double beta =
      std::max((qp.b.array() / s).abs().maxCoeff(), std::numeric_limits<double>::min());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double wi = w[i] / s[i] / beta;
    const double above = (x[i] - qp.lower[i]) * s[i] / beta;  // room to the bounds, inf where free
    const double below = (qp.upper[i] - x[i]) * s[i] / beta;
    // w > 0 wants x at its lower bound, w < 0 at its upper one: an infinite bound makes w an error.
    const double room = wi > 0 ? above : below;
    if (std::isinf(room)) {
      r.primal = std::max(r.primal, std::abs(wi));
    } else {
      r.complementarity = std::max(r.complementarity, std::abs(wi) * std::max(room, 0.0));
    }
    r.primal = std::max({r.primal, -above, -below});
    if (std::isnan(wi)) {
      r.primal = std::numeric_limits<double>::infinity();
    }
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
  // Jacobi scaling first: rows of different units (cm/s, rad/s) must not decide the rank.
  const Eigen::VectorXd s =
      A.diagonal().array().max(std::numeric_limits<double>::min()).sqrt().inverse();
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(
      s.asDiagonal() * A * s.asDiagonal());
  const Eigen::VectorXd scaled = s.cwiseProduct(b);
  BoxQpSolution solution;
  const Eigen::VectorXd y = factor.solve(scaled);
  solution.x = s.cwiseProduct(y);
  solution.iterations = 1;
  const double residual =
      (s.asDiagonal() * A * s.asDiagonal() * y - scaled).lpNorm<Eigen::Infinity>();
  // Consistent equations are met to rounding; 1e-9 of the right-hand side is far above that and
  // far below any row that really contradicts another.
  const bool met = residual <= 1e-9 * scaled.lpNorm<Eigen::Infinity>();
  solution.status = met ? SolveStatus::solved : SolveStatus::infeasible;
  return solution;
}

}  // namespace hagfish
