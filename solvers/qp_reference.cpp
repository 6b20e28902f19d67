#include "solvers/qp_reference.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

/// Rounding of a sum of some hundred terms in long double, over the sum of their sizes.
constexpr long double tight = 1e3L * std::numeric_limits<long double>::epsilon();
/// A point is the solution where each row's error is below this share of the terms that make it
/// up: a few roundings of the entries of A and b, which came as doubles.
constexpr long double accepted = 4 * std::numeric_limits<double>::epsilon();
/// Pivots below this share of the largest are the rounding of A's own entries: their rows depend on
/// others.
constexpr long double rank_threshold = 1e-14L;
/// Blocks that may fail to lessen the number of wrong rows before rows change singly.
constexpr int patience = 5;
/// Changes that are tried, over the number of rows.
constexpr int changes_per_row = 10;

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// R with R'R = A (unit diagonal, semidefinite) but for what is rounding of A's entries.
LongMatrix root_of(const LongMatrix& A) {
  const Eigen::LDLT<LongMatrix> factor(A);  // pivots fall
  Eigen::Index rank = 0;
  while (rank < A.rows() && factor.vectorD()[rank] > rank_threshold) ++rank;
  const LongMatrix lower = factor.matrixL();
  const LongMatrix in_order = factor.transpositionsP().transpose() * lower.leftCols(rank);
  return factor.vectorD().head(rank).cwiseSqrt().asDiagonal() * in_order.transpose();
}

}  // namespace

QpReference::QpReference(const BoxQp& qp) {
  check_box_qp(qp);
  A_ = qp.A.cast<Real>();
  b_ = qp.b.cast<Real>();
  scale(qp);
  if (b_.size() > 0) half_ = root_of(A_);
}

QpReference::QpReference(const PrimalQp& qp) {
  const BoxQp dual = dual_of(qp);
  const Matrix rows = all_rows(qp).cast<Real>();
  Vector rhs(dual.b.size());
  rhs << qp.e.cast<Real>(), qp.d.cast<Real>();
  const Eigen::LLT<Matrix> factor(qp.H.cast<Real>());
  free_velocity_ = factor.solve(qp.g.cast<Real>());
  half_ = rows.transpose();
  response_ = half_;
  if (half_.size() > 0) {  // Eigen refers to the first entry, also where there is none
    factor.matrixL().solveInPlace(half_);
    response_ = factor.matrixU().solve(half_);
  }
  A_ = half_.transpose() * half_;
  b_ = rhs - rows * free_velocity_;
  scale(dual);
  half_ = (half_ * scale_.cwiseInverse().asDiagonal()).eval();
}

/// Brings A_, b_ and the bounds to the scale of `qp`, the problem as back ends see it.
void QpReference::scale(const BoxQp& qp) {
  const Eigen::VectorXd scale = row_scale(qp.A);
  scale_ = scale.cast<Real>();
  beta_ = rhs_scale(qp, scale);
  const Vector inverse = scale_.cwiseInverse();
  A_ = (inverse.asDiagonal() * A_ * inverse.asDiagonal()).eval();
  b_ = inverse.cwiseProduct(b_) / beta_;
  lower_ = scale_.cwiseProduct(qp.lower.cast<Real>()) / beta_;
  upper_ = scale_.cwiseProduct(qp.upper.cast<Real>()) / beta_;
}

/// Moves the active rows to w = 0; those that depend on others share the change.
void QpReference::solve_active() {
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < b_.size(); ++i) {
    if (side_[i] == Side::active) active.push_back(i);
  }
  if (active.empty()) return;
  Eigen::CompleteOrthogonalDecomposition<Matrix> factor;
  factor.setThreshold(rank_threshold);
  factor.compute(A_(active, active));
  for (int refinement = 0; refinement < 3; ++refinement) {
    const Vector missing = b_(active) - A_(active, Eigen::all) * x_;
    x_(active) += factor.solve(missing);
  }
}

/// Lists the rows on the wrong side, with the side to change to; returns the worst row's error over
/// its terms.
QpReference::Real QpReference::judge() {
  wrong_.clear();
  Real worst = 0;
  const Real largest = x_.size() > 0 ? x_.lpNorm<Eigen::Infinity>() : 0;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const Real w = A_.row(i).dot(x_) - b_[i];
    const Real terms = A_.row(i).cwiseAbs().dot(x_.cwiseAbs()) + std::abs(b_[i]);
    Real error = 0;
    switch (side_[i]) {
      case Side::active: {
        // Where dependent rows contradict each other by their rounding, those with w > 0 are met
        // without activating them.
        const Real noise = accepted * terms;
        if (x_[i] < lower_[i] - tight * largest || (w > noise && std::isfinite(lower_[i]))) {
          wrong_.emplace_back(i, Side::lower);
        } else if (x_[i] > upper_[i] + tight * largest ||
                   (-w > noise && std::isfinite(upper_[i]))) {
          wrong_.emplace_back(i, Side::upper);
        }
        error = std::max({std::abs(w), lower_[i] - x_[i], x_[i] - upper_[i]});
        break;
      }
      case Side::lower:
        error = lower_[i] < upper_[i] ? std::max(-w, Real{0}) : 0;
        break;
      case Side::upper:
        error = std::max(w, Real{0});
        break;
    }
    if (side_[i] != Side::active && error > tight * terms) wrong_.emplace_back(i, Side::active);
    worst = std::max(worst, error > 0 ? error / std::max(terms, largest) : 0);
  }
  return worst;
}

bool QpReference::solve(const Eigen::VectorXd& guess) {
  x_ = scale_.cwiseProduct(guess.cast<Real>()) / beta_;
  const Vector w = A_ * x_ - b_;
  side_.assign(b_.size(), Side::active);
  const auto move = [this](Eigen::Index i, Side side) {
    side_[i] = side;
    if (side != Side::active) x_[i] = side == Side::lower ? lower_[i] : upper_[i];
  };
  for (Eigen::Index i = 0; i < b_.size(); ++i) {
    if (x_[i] - lower_[i] < w[i] || !(lower_[i] < upper_[i])) {
      move(i, Side::lower);
    } else if (upper_[i] - x_[i] < -w[i]) {
      move(i, Side::upper);
    }
  }
  auto least = wrong_.max_size();
  int tries = patience;
  for (Eigen::Index change = 0; change <= changes_per_row * b_.size(); ++change) {
    solve_active();
    const Real error = judge();
    if (wrong_.empty()) return error <= accepted;
    if (wrong_.size() < least) {
      least = wrong_.size();
      tries = patience;
    } else if (--tries < 0) {
      wrong_.erase(wrong_.begin(), wrong_.end() - 1);  // Murty's rule: the last row alone
    }
    for (const auto& [i, side] : wrong_) move(i, side);
  }
  return false;
}

VelocityError QpReference::error(const Eigen::VectorXd& x) const {
  const Vector scaled = scale_.cwiseProduct(x.cast<Real>()) / beta_;
  const Vector difference = scaled - x_;
  const Real unit = std::max(norm(x_), Real{1});  // both over beta_
  VelocityError error;
  error.norm = static_cast<double>(beta_ * norm(difference));
  error.relative = static_cast<double>(norm(difference) / unit);
  if (free_velocity_.size() > 0 && x.size() > 0) {
    const auto velocity = [this](const Vector& y) -> Vector {
      return response_ * (beta_ * y.cwiseQuotient(scale_));
    };
    const Real largest = velocity(difference).lpNorm<Eigen::Infinity>();
    // Of a velocity that the rows bring to nothing, what they take is known.
    const Real reference = std::max((free_velocity_ + velocity(x_)).lpNorm<Eigen::Infinity>(),
                                    free_velocity_.lpNorm<Eigen::Infinity>());
    error.largest = static_cast<double>(largest);
    error.largest_relative = largest > 0 ? static_cast<double>(largest / reference) : 0;
  }
  return error;
}

}  // namespace hagfish
