#include "tests/support/random_qp.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

// std::uniform_real_distribution differs between libraries; this does not.
double draw(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

Eigen::MatrixXd draw_matrix(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return draw(random, -1, 1); });
}

Eigen::VectorXd draw_units(std::mt19937& random, Eigen::Index size, double spread) {
  return Eigen::VectorXd::NullaryExpr(size, [&] { return std::pow(spread, draw(random, -1, 1)); });
}

}  // namespace

KnownQp known_qp(std::mt19937& random, Eigen::Index n, const std::vector<Role>& roles,
                 double spread) {
  const auto m = static_cast<Eigen::Index>(roles.size());
  KnownQp known;
  PrimalQp& qp = known.primal;
  const Eigen::MatrixXd B = draw_matrix(random, n, n);
  qp.H = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd J = draw_matrix(random, m, n);
  known.v = draw_matrix(random, n, 1);
  known.x.setZero(m);
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(m);
  Eigen::VectorXd cap = Eigen::VectorXd::Constant(m, no_bound);
  Eigen::Index bilateral = 0;
  for (Eigen::Index i = 0; i < m; ++i) {
    const double size = draw(random, 0.1, 1);
    switch (roles[i]) {
      case Role::bilateral:
        known.x[i] = i % 2 == 0 ? size : -size;
        ++bilateral;
        break;
      case Role::active:
        known.x[i] = size;
        break;
      case Role::inactive:
        excess[i] = size;
        break;
      case Role::degenerate:
        break;
      case Role::soft:
        known.x[i] = size;
        cap[i] = 1.5 * size;
        break;
      case Role::at_cap:
        known.x[i] = cap[i] = size;
        excess[i] = -draw(random, 0.1, 1);
        break;
      case Role::copy:
        J.row(i) = J.row(i - 1);
        known.x[i] = size;
        break;
    }
  }
  // Units last: v = D v', rows = E rows', multipliers = multipliers' / E.
  const Eigen::VectorXd D = draw_units(random, n, spread);
  const Eigen::VectorXd E = draw_units(random, m, spread);
  qp.H = (D.cwiseInverse().asDiagonal() * qp.H * D.cwiseInverse().asDiagonal()).eval();
  J = (E.asDiagonal() * J * D.cwiseInverse().asDiagonal()).eval();
  known.v = D.cwiseProduct(known.v).eval();
  known.x = known.x.cwiseQuotient(E).eval();
  cap = cap.cwiseQuotient(E).eval();
  const Eigen::VectorXd rhs = J * known.v - E.cwiseProduct(excess);
  qp.g = qp.H * known.v - J.transpose() * known.x;
  qp.G = J.topRows(bilateral);
  qp.e = rhs.head(bilateral);
  qp.C = J.bottomRows(m - bilateral);
  qp.d = rhs.tail(m - bilateral);
  qp.cap = cap.tail(m - bilateral);
  known.dual = dual_of(qp);
  return known;
}

std::vector<Role> each_role(int count) {
  std::vector<Role> roles;
  for (const Role role : {Role::bilateral, Role::active, Role::inactive, Role::degenerate,
                          Role::soft, Role::at_cap}) {
    roles.insert(roles.end(), count, role);
  }
  return roles;
}

BoxQp unilateral_qp(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return {A, b, Eigen::VectorXd::Zero(b.size()), Eigen::VectorXd::Constant(b.size(), no_bound)};
}

BoxQp qp_of_rows(const Eigen::MatrixXd& J, const Eigen::VectorXd& b) {
  return unilateral_qp(J * J.transpose(), b);
}

Eigen::VectorXd velocity_of(const PrimalQp& primal, const Eigen::VectorXd& x) {
  const Eigen::Index p = primal.e.size();
  return primal.H.llt().solve(primal.g + primal.G.transpose() * x.head(p) +
                              primal.C.transpose() * x.tail(x.size() - p));
}

double velocity_error(const PrimalQp& primal, const Eigen::VectorXd& v,
                      const Eigen::VectorXd& other) {
  const Eigen::VectorXd difference = v - other;
  return std::sqrt(difference.dot(primal.H * difference) / other.dot(primal.H * other));
}

}  // namespace hagfish
