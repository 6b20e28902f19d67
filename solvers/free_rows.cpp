#include "solvers/free_rows.hpp"

#include <cmath>
#include <limits>

namespace hagfish {
namespace {

/// Pivots below this share of the largest are rounding: rows are unit vectors in the H⁻¹ metric,
/// so they would have to agree to 1e-6 rad.
constexpr double rank_threshold = 1e-12;
/// Consistent equations are met to about 1e-15 of the right-hand side; rows that contradict each
/// other miss by far more than this.
constexpr double consistency = 1e-9;
/// Of the terms that make up what is left of b.
constexpr double terms_rounding = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

SemidefiniteFactor::SemidefiniteFactor(const Eigen::MatrixXd& A)
    : inverse_scale_(row_scale(A).cwiseInverse()),
      scaled_(inverse_scale_.asDiagonal() * A * inverse_scale_.asDiagonal()) {
  factor_.setThreshold(rank_threshold);
  factor_.compute(scaled_);
}

Eigen::MatrixXd SemidefiniteFactor::solve(const Eigen::MatrixXd& b) const {
  if (b.cols() == 0) {
    return b;  // Eigen's solve would refer to its first entry
  }
  return inverse_scale_.asDiagonal() * factor_.solve(inverse_scale_.asDiagonal() * b);
}

bool SemidefiniteFactor::meets(const Eigen::VectorXd& x, const Eigen::VectorXd& b,
                               const Eigen::VectorXd& rounding) const {
  const Eigen::VectorXd right = inverse_scale_.cwiseProduct(b);
  const Eigen::VectorXd unsure = inverse_scale_.cwiseProduct(rounding);
  const Eigen::VectorXd residual = scaled_ * x.cwiseQuotient(inverse_scale_) - right;
  // A row's error is spread over those that depend on it.
  return residual.lpNorm<Eigen::Infinity>() <=
         consistency * right.lpNorm<Eigen::Infinity>() + unsure.lpNorm<1>();
}

BoundedPart::BoundedPart(const BoxQp& qp) : size_(qp.b.size()) {
  std::vector<Eigen::Index> bounded;
  for (Eigen::Index i = 0; i < size_; ++i) {
    const bool is_free = std::isinf(qp.lower[i]) && std::isinf(qp.upper[i]);
    (is_free ? free_ : bounded).push_back(i);
  }
  Eigen::MatrixXd S = qp.A(bounded, bounded);
  Eigen::VectorXd c = qp.b(bounded);
  const Eigen::VectorXd unsure =
      qp.rounding.size() > 0 ? qp.rounding : Eigen::VectorXd(Eigen::VectorXd::Zero(size_));
  Eigen::VectorXd c_rounding = unsure(bounded);
  Eigen::MatrixXd response(0, c.size());
  if (!free_.empty()) {
    const SemidefiniteFactor factor(qp.A(free_, free_));
    const Eigen::MatrixXd coupling = qp.A(free_, bounded);
    const Eigen::VectorXd b = qp.b(free_);
    free_at_zero_ = factor.solve(b);
    response = -factor.solve(coupling);
    consistent_ = factor.meets(free_at_zero_, b, unsure(free_));
    S += coupling.transpose() * response;
    S = (0.5 * (S + S.transpose())).eval();
    c_rounding += terms_rounding *
                      (c.cwiseAbs() + coupling.transpose().cwiseAbs() * free_at_zero_.cwiseAbs()) +
                  response.transpose().cwiseAbs() * unsure(free_);
    c -= coupling.transpose() * free_at_zero_;
  }
  const Eigen::VectorXd scale = row_scale(qp.A);
  const double beta = rhs_scale(qp, scale);
  left_out_ = Eigen::VectorXd::Zero(size_);
  std::vector<Eigen::Index> inside;  // of the bounded rows, those kept
  for (Eigen::Index k = 0; k < c.size(); ++k) {
    const Eigen::Index i = bounded[k];
    if (!(qp.lower[i] < qp.upper[i])) continue;
    if (S(k, k) > rank_threshold * scale[i] * scale[i]) {
      inside.push_back(k);
      kept_.push_back(i);
    } else if (std::abs(c[k]) > consistency * scale[i] * beta + c_rounding[k]) {
      // The free rows, or a zero diagonal, fix this row's speed, which is wrong: it pushes all that
      // it may, in vain.
      left_out_[i] = c[k] > 0 ? qp.upper[i] : qp.lower[i];
      if (std::isinf(left_out_[i])) {
        consistent_ = false;
        left_out_[i] = 0;
      } else if (!free_.empty()) {
        free_at_zero_ += response.col(k) * left_out_[i];
      }
    }
  }
  free_response_ = response(Eigen::all, inside);
  reduced_ = {S(inside, inside), c(inside), qp.lower(kept_), qp.upper(kept_), c_rounding(inside)};
}

Eigen::VectorXd BoundedPart::expand(const Eigen::VectorXd& reduced_x) const {
  Eigen::VectorXd x = left_out_;
  x(kept_) = reduced_x;
  if (!free_.empty()) x(free_) = free_at_zero_ + free_response_ * reduced_x;
  return x;
}

}  // namespace hagfish
