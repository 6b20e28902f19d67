#include "solvers/fixed_point.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hagfish {
namespace {

/// Added to the diagonal of the normal equations, as a share of their trace: changes that repeat
/// each other leave them singular.
constexpr double least_pivot = 1e-12;

}  // namespace

void AndersonMixing::mix(const Eigen::VectorXd& x, const Eigen::VectorXd& g,
                         Eigen::VectorXd& next) {
  residual_ = g - x;
  next = g;
  if (passes_ == 0) {
    residual_change_.resize(x.size(), depth);
    g_change_.resize(x.size(), depth);
  } else {
    const int newest = (passes_ - 1) % depth;
    residual_change_.col(newest) = residual_ - last_residual_;
    g_change_.col(newest) = g - last_g_;
    const int known = std::min(passes_, depth);
    const auto changes = residual_change_.leftCols(known);
    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, depth, depth>;
    Small normal(known, known);
    normal.noalias() = changes.transpose() * changes;
    const double trace = normal.trace();
    if (trace > 0) {
      normal.diagonal().array() += least_pivot * trace;
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, depth, 1> share(known);
      share.noalias() = changes.transpose() * residual_;
      normal.llt().solveInPlace(share);
      next.noalias() -= g_change_.leftCols(known) * share;
    }
  }
  last_residual_ = residual_;
  last_g_ = g;
  ++passes_;
}

}  // namespace hagfish
