#include "solvers/box_qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/active_set.hpp"
#if defined(HAGFISH_IPOPT)
#include "solvers/ipopt_box_qp.hpp"
#endif

namespace hagfish {
namespace {

/// Of the largest entry of row_scale(A): rows below it cannot move.
constexpr double immovable_share = 1e-20;
/// Of the same: the scale of rows that cannot move.
constexpr double least_share = 1e-10;

/// `w` brought nearer to 0 by `rounding`, but not past it.
double beyond(double w, double rounding) {
  return rounding == 0 ? w : std::copysign(std::max(std::abs(w) - rounding, 0.0), w);
}

}  // namespace

void check_box_qp(const BoxQp& qp) {
  const Eigen::Index m = qp.b.size();
  if (qp.A.rows() != m || qp.A.cols() != m || qp.lower.size() != m || qp.upper.size() != m ||
      (qp.rounding.size() != m && qp.rounding.size() != 0)) {
    throw std::invalid_argument("box QP: A, b, lower and upper differ in size");
  }
  // 0 * A is not 0 where A is not finite; unlike allFinite, the sum is vectorised.
  if ((0 * qp.A).sum() != 0 || !qp.b.allFinite()) {
    throw std::invalid_argument("box QP: A or b is not finite");
  }
  if (!((qp.lower.array() <= 0).all() && (qp.upper.array() >= 0).all())) {
    throw std::invalid_argument("box QP: the bounds must include 0");
  }
}

Eigen::VectorXd row_scale(const Eigen::MatrixXd& A) {
  Eigen::VectorXd s(A.rows());
  row_scale(A, s);
  return s;
}

void row_scale(const Eigen::MatrixXd& A, Eigen::Ref<Eigen::VectorXd> s) {
  if (s.size() == 0) return;
  s = A.diagonal().cwiseMax(0);  // side by side in memory, so that roots are taken in packets
  s = s.cwiseSqrt();
  const double largest = s.maxCoeff();
  const double least = largest > 0 ? least_share * largest : 1.0;
  s = (s.array() > immovable_share * largest).select(s, least);
}

double rhs_scale(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& s) {
  double beta = 0;
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const double size = std::abs(qp.b[i]);
    if (size > beta * s[i] && pushes_at_zero(qp, i) && qp.A(i, i) > 0.5 * s[i] * s[i]) {
      beta = size / s[i];
    }
  }
  return beta > 0 ? beta : 1;
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x) {
  return kkt_residuals(qp, x, qp.A * x - qp.b, row_scale(qp.A));
}

KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& w,
                           const Eigen::Ref<const Eigen::VectorXd>& s, double least_beta) {
  const double beta = std::max(rhs_scale(qp, s), least_beta);
  KktResiduals r;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double wi = beyond(w[i], b_rounding(qp, i)) / s[i] / beta;
    if (!std::isfinite(x[i]) || !std::isfinite(wi)) {
      r.primal = std::numeric_limits<double>::infinity();
      return r;
    }
    const double above = (x[i] - qp.lower[i]) * s[i] / beta;  // room to the bounds, inf where free
    const double below = (qp.upper[i] - x[i]) * s[i] / beta;
    const double room = wi > 0 ? above : below;
    if (std::isinf(room)) {
      r.primal = std::max(r.primal, std::abs(wi));
    } else {
      const double size = std::max(1.0, std::abs(x[i]) * s[i] / beta);
      r.complementarity = std::max(r.complementarity, std::abs(wi) * std::clamp(room, 0.0, size));
    }
    r.primal = std::max({r.primal, -above, -below});
  }
  return r;
}

std::vector<std::string> box_qp_solver_names() {
#if defined(HAGFISH_IPOPT)
  return {"ipopt", "active-set"};
#else
  return {"active-set"};
#endif
}

std::unique_ptr<BoxQpSolver> make_box_qp_solver(const std::string& name) {
#if defined(HAGFISH_IPOPT)
  if (name == "ipopt") return std::make_unique<IpoptBoxQp>();
#endif
  if (name == "active-set") return std::make_unique<ActiveSetBoxQp>();
  std::string known;
  for (const std::string& one : box_qp_solver_names()) known += (known.empty() ? "" : ", ") + one;
  throw std::invalid_argument("unknown QP back end '" + name + "' (there are: " + known + ")");
}

}  // namespace hagfish
