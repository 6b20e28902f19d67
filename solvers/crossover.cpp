#include "solvers/crossover.hpp"

namespace hagfish {
namespace {

/// Natural residual of a settled point. Rounding gives 1e-16 to 1e-13 with the condition of A.
constexpr double settled = 1e-10;

}  // namespace

double natural_residual(const BoxQp& qp, const Eigen::VectorXd& x) {
  const Eigen::VectorXd wish = x - (qp.A * x - qp.b);
  return (x - wish.cwiseMax(qp.lower).cwiseMin(qp.upper)).lpNorm<Eigen::Infinity>();
}

ActiveSetPivoting::Ending pivot_from(const BoxQp& qp, const Eigen::VectorXd& x,
                                     ActiveSetPivoting& pivoting) {
  pivoting.start(qp);
  // Distances and gradients on the scale of unit diagonal.
  const Eigen::VectorXd w = (qp.A * x - qp.b).cwiseQuotient(pivoting.scale().cwiseAbs2());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x[i] - qp.lower[i] < w[i]) {
      pivoting.fix(i, qp.lower[i]);
    } else if (qp.upper[i] - x[i] < -w[i]) {
      pivoting.fix(i, qp.upper[i]);
    } else {
      pivoting.fix(i, x[i]);
      pivoting.activate(i);
    }
  }
  return pivoting.change_blocks() ? ActiveSetPivoting::Ending::settled : pivoting.change_singly();
}

Eigen::VectorXd crossover(const BoxQp& qp, const Eigen::VectorXd& x) {
  ActiveSetPivoting pivoting;
  if (pivot_from(qp, x, pivoting) != ActiveSetPivoting::Ending::settled) return x;
  const Eigen::VectorXd point = pivoting.x();
  const double residual = natural_residual(qp, point);
  return residual <= settled && residual < natural_residual(qp, x) ? point : x;
}

}  // namespace hagfish
