#include "experiments/film/fit/block_arrow.hpp"

namespace hagfish {

BlockArrow::BlockArrow(Eigen::Index blocks, Eigen::Index size, Eigen::Index border)
    : blocks_(blocks), size_(size), border_(border), pairs_((blocks + 1) / 2) {
  clear();
}

void BlockArrow::clear() {
  own_.assign(pairs_, Eigen::MatrixXd::Zero(2 * size_, 2 * size_));
  below_.assign(pairs_, Eigen::MatrixXd::Zero(2 * size_, 2 * size_));
  beside_.assign(pairs_, Eigen::MatrixXd::Zero(2 * size_, border_));
  corner_ = Eigen::MatrixXd::Zero(border_, border_);
  // The second half of an odd number's last pair stands for nothing.
  if (blocks_ % 2 != 0) own_.back().diagonal().tail(size_).setOnes();
}

void BlockArrow::add(Eigen::Index i, Eigen::Index j, const Eigen::MatrixXd& part) {
  if (i < j) return add(j, i, part.transpose());
  const Eigen::Index row = (i % 2) * size_, column = (j % 2) * size_;
  if (i / 2 == j / 2) {
    own_[i / 2].block(row, column, size_, size_) += part;
    if (i != j) own_[i / 2].block(column, row, size_, size_) += part.transpose();
  } else {
    below_[j / 2].block(row, column, size_, size_) += part;
  }
}

void BlockArrow::add_diagonal(Eigen::Index i, Eigen::Index row, Eigen::Index column, double value) {
  own_[i / 2]((i % 2) * size_ + row, (i % 2) * size_ + column) += value;
}

void BlockArrow::add_border(Eigen::Index i, const Eigen::MatrixXd& part) {
  beside_[i / 2].middleRows((i % 2) * size_, size_) += part;
}

Eigen::VectorXd BlockArrow::diagonal() const {
  Eigen::VectorXd diagonal(blocks_ * size_ + border_);
  for (Eigen::Index i = 0; i < blocks_; ++i) {
    diagonal.segment(i * size_, size_) = own_[i / 2].diagonal().segment((i % 2) * size_, size_);
  }
  diagonal.tail(border_) = corner_.diagonal();
  return diagonal;
}

bool BlockArrow::factor(double damping) {
  factor_.resize(pairs_);
  ahead_.resize(pairs_);
  for (Eigen::Index k = 0; k < pairs_; ++k) {
    Eigen::MatrixXd own = own_[k];
    own.diagonal() *= 1 + damping;
    if (k > 0) own.noalias() -= below_[k - 1] * ahead_[k - 1];
    factor_[k].compute(own);
    if (factor_[k].info() != Eigen::Success) return false;
    if (k + 1 < pairs_) ahead_[k] = factor_[k].solve(below_[k].transpose());
  }
  if (border_ == 0) return true;
  Eigen::MatrixXd beside(pairs_ * 2 * size_, border_);
  for (Eigen::Index k = 0; k < pairs_; ++k) {
    beside.middleRows(k * 2 * size_, 2 * size_) = beside_[k];
  }
  beside_solved_ = chain_solve(beside);
  Eigen::MatrixXd corner = corner_;
  corner.diagonal() *= 1 + damping;
  corner -= beside.transpose() * beside_solved_;
  corner_factor_.compute(corner);
  return corner_factor_.info() == Eigen::Success;
}

Eigen::MatrixXd BlockArrow::chain_solve(const Eigen::MatrixXd& right) const {
  const Eigen::Index n = 2 * size_;
  Eigen::MatrixXd x = right;
  for (Eigen::Index k = 1; k < pairs_; ++k) {
    x.middleRows(k * n, n) -= ahead_[k - 1].transpose() * x.middleRows((k - 1) * n, n);
  }
  for (Eigen::Index k = pairs_ - 1; k >= 0; --k) {
    x.middleRows(k * n, n) = factor_[k].solve(x.middleRows(k * n, n)).eval();
    if (k + 1 < pairs_) x.middleRows(k * n, n) -= ahead_[k] * x.middleRows((k + 1) * n, n);
  }
  return x;
}

Eigen::VectorXd BlockArrow::solve(const Eigen::VectorXd& right) const {
  const Eigen::Index count = blocks_ * size_;
  Eigen::VectorXd chain = Eigen::VectorXd::Zero(pairs_ * 2 * size_);
  chain.head(count) = right.head(count);
  Eigen::VectorXd x(count + border_);
  Eigen::VectorXd own = chain_solve(chain);
  if (border_ > 0) {
    const Eigen::VectorXd rest = right.tail(border_) - beside_solved_.transpose() * chain;
    x.tail(border_) = corner_factor_.solve(rest);
    own -= beside_solved_ * x.tail(border_);
  }
  x.head(count) = own.head(count);
  return x;
}

BlockArrow::Inverse BlockArrow::inverse() const {
  const Eigen::Index n = 2 * size_;
  std::vector<Eigen::MatrixXd> own(pairs_), below(pairs_);
  for (Eigen::Index k = pairs_ - 1; k >= 0; --k) {
    own[k] = factor_[k].solve(Eigen::MatrixXd::Identity(n, n));
    if (k + 1 == pairs_) continue;
    below[k] = -own[k + 1] * ahead_[k].transpose();
    own[k] -= ahead_[k] * below[k];
  }
  if (border_ > 0) {
    const Eigen::MatrixXd corner =
        corner_factor_.solve(Eigen::MatrixXd::Identity(border_, border_));
    for (Eigen::Index k = 0; k < pairs_; ++k) {
      const Eigen::MatrixXd y = beside_solved_.middleRows(k * n, n) * corner;
      own[k] += y * beside_solved_.middleRows(k * n, n).transpose();
      if (k + 1 < pairs_) {
        below[k] += beside_solved_.middleRows((k + 1) * n, n) * y.transpose();
      }
    }
  }
  Inverse inverse;
  const auto part = [&](Eigen::Index i, Eigen::Index j) -> Eigen::MatrixXd {
    const Eigen::MatrixXd& of = i / 2 == j / 2 ? own[i / 2] : below[j / 2];
    return of.block((i % 2) * size_, (j % 2) * size_, size_, size_);
  };
  for (Eigen::Index i = 0; i < blocks_; ++i) {
    inverse.own.push_back(part(i, i));
    if (i + 1 < blocks_) inverse.one_below.push_back(part(i + 1, i));
    if (i + 2 < blocks_) inverse.two_below.push_back(part(i + 2, i));
  }
  return inverse;
}

}  // namespace hagfish
