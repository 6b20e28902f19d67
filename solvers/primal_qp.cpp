#include "solvers/primal_qp.hpp"

#include <Eigen/Cholesky>
#include <limits>
#include <stdexcept>

namespace hagfish {
namespace {

/// Of the terms of a right-hand side: those of some hundred velocities, each off by a few of the
/// last bits.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

void check_primal_qp(const PrimalQp& qp) {
  const Eigen::Index n = qp.g.size();
  if (qp.H.rows() != n || qp.H.cols() != n || qp.G.rows() != qp.e.size() ||
      qp.C.rows() != qp.d.size() || qp.cap.size() != qp.d.size() ||
      (qp.e.size() > 0 && qp.G.cols() != n) || (qp.d.size() > 0 && qp.C.cols() != n)) {
    throw std::invalid_argument("primal QP: H, g, G, e, C, d and cap differ in size");
  }
}

Eigen::MatrixXd all_rows(const PrimalQp& qp) {
  Eigen::MatrixXd J(qp.e.size() + qp.d.size(), qp.g.size());
  if (qp.e.size() > 0) J.topRows(qp.e.size()) = qp.G;
  if (qp.d.size() > 0) J.bottomRows(qp.d.size()) = qp.C;
  return J;
}

BoxQp dual_of(const PrimalQp& qp) {
  check_primal_qp(qp);
  const Eigen::LLT<Eigen::MatrixXd> factor(qp.H);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("primal QP: H is not positive definite");
  }
  const Eigen::MatrixXd J = all_rows(qp);
  const Eigen::Index p = qp.e.size();
  BoxQp dual;
  if (J.rows() == 0) return dual;
  const Eigen::MatrixXd half = factor.matrixL().solve(J.transpose());
  dual.A = half.transpose() * half;
  dual.b.resize(J.rows());
  dual.b << qp.e, qp.d;
  const Eigen::VectorXd free_velocity = factor.solve(qp.g);
  dual.rounding = rounding * (dual.b.cwiseAbs() + J.cwiseAbs() * free_velocity.cwiseAbs());
  dual.b -= J * free_velocity;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  dual.lower = Eigen::VectorXd::Zero(J.rows());
  dual.lower.head(p).setConstant(-infinity);
  dual.upper = Eigen::VectorXd::Constant(J.rows(), infinity);
  dual.upper.tail(qp.cap.size()) = qp.cap;
  return dual;
}

}  // namespace hagfish
