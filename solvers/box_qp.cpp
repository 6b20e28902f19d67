#include "solvers/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/active_set.hpp"
#include "solvers/ipopt_box_qp.hpp"

namespace hagfish {

const char* status_name(SolveStatus status) {
  switch (status) {
    case SolveStatus::solved:
      return "solved";
    case SolveStatus::infeasible:
      return "infeasible";
    case SolveStatus::stopped:
      return "stopped";
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
  // 0 * A is not 0 where A is not finite; unlike allFinite, the sum is vectorised.
  if ((0 * qp.A).sum() != 0 || !qp.b.allFinite()) {
    throw std::invalid_argument("box QP: A or b is not finite");
  }
  if (!((qp.lower.array() <= 0).all() && (qp.upper.array() >= 0).all())) {
    throw std::invalid_argument("box QP: bounds leave out 0");
  }
}

namespace {

/// row_scale(A) entry by entry.
class RowScale {
 public:
  explicit RowScale(const Eigen::MatrixXd& A) : A_(A) {
    const double largest = A.size() > 0 ? std::sqrt(std::max(A.diagonal().maxCoeff(), 0.0)) : 0;
    least_ = largest > 0 ? 1e-10 * largest : 1.0;
  }
  bool can_move(Eigen::Index i) const { return A_(i, i) >= least_ * least_; }
  double operator[](Eigen::Index i) const { return can_move(i) ? std::sqrt(A_(i, i)) : least_; }

 private:
  const Eigen::MatrixXd& A_;
  double least_;
};

}  // namespace

Eigen::VectorXd row_scale(const Eigen::MatrixXd& A) {
  Eigen::VectorXd s(A.rows());
  row_scale(A, s);
  return s;
}

void row_scale(const Eigen::MatrixXd& A, Eigen::Ref<Eigen::VectorXd> s) {
  const RowScale scale(A);
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    s[i] = scale[i];
  }
}

double rhs_scale(const BoxQp& qp) {
  const RowScale scale(qp.A);
  double beta = 0;
  for (Eigen::Index i = 0; i < qp.b.size(); ++i) {
    if (scale.can_move(i)) {
      beta = std::max(beta, std::abs(qp.b[i]) / scale[i]);
    }
  }
  return beta > 0 ? beta : 1;
}

namespace {

/// `gradient(i)` is w_i.
template <class Gradient>
KktResiduals residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x, double beta,
                       const Gradient& gradient) {
  KktResiduals r;
  const RowScale s(qp.A);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double si = s[i];
    const double wi = gradient(i) / si / beta;
    if (!std::isfinite(x[i]) || !std::isfinite(wi)) {
      r.primal = std::numeric_limits<double>::infinity();
      return r;
    }
    const double above = (x[i] - qp.lower[i]) * si / beta;  // room to the bounds, inf where free
    const double below = (qp.upper[i] - x[i]) * si / beta;
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

}  // namespace

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x) {
  return residuals(qp, x, rhs_scale(qp),
                   [&](Eigen::Index i) { return qp.A.col(i).dot(x) - qp.b[i]; });
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& w, double least_beta) {
  const double beta = std::max(rhs_scale(qp), least_beta);
  return residuals(qp, x, beta, [&](Eigen::Index i) { return w[i]; });
}

std::vector<std::string> box_qp_solver_names() { return {"ipopt", "active-set"}; }

std::unique_ptr<BoxQpSolver> make_box_qp_solver(const std::string& name) {
  if (name == "ipopt") {
    return std::make_unique<IpoptBoxQp>();
  }
  if (name == "active-set") {
    return std::make_unique<ActiveSetBoxQp>();
  }
  throw std::invalid_argument("unknown QP back end '" + name + "' (there are: ipopt, active-set)");
}

}  // namespace hagfish
