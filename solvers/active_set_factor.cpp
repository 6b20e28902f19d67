#include "solvers/active_set_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

/// As in free_rows.cpp: smaller pivots of a matrix of unit diagonal are rounding.
constexpr double rank_threshold = 1e-12;
/// Pivots above this are not: they are told from rounding without a closer look.
constexpr double clear_pivot = 1e-4;
/// Rounding of A and of the factor, in entries of A brought to unit diagonal.
constexpr double entry_rounding = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

void ActiveSetFactor::reset(const Eigen::MatrixXd& A,
                            const Eigen::Map<Eigen::VectorXd>& inverse_scale) {
  const Eigen::Index m = A.rows();
  A_ = &A;
  inverse_scale_ = &inverse_scale;
  if (L_.rows() < m) {
    L_.resize(m, m);
    work_.resize(m);
    rows_.reserve(m);
  }
  rows_.clear();
  held_.assign(m, 0);
}

bool ActiveSetFactor::append(std::span<const Eigen::Index> added) {
  const auto known = static_cast<Eigen::Index>(rows_.size());
  rows_.insert(rows_.end(), added.begin(), added.end());
  return factorise_tail(known);
}

void ActiveSetFactor::remove(std::span<const Eigen::Index> dropped) {
  for (const Eigen::Index row : dropped) {
    held_[row] = 0;
  }
  const auto gone = [this](Eigen::Index row) { return held_[row] == 0; };
  const auto first = std::find_if(rows_.begin(), rows_.end(), gone);
  const auto known = first - rows_.begin();
  rows_.erase(std::remove_if(first, rows_.end(), gone), rows_.end());
  factorise_tail(known);
}

/// Factorises rows_ from position `known` on, column by column.
bool ActiveSetFactor::factorise_tail(Eigen::Index known) {
  const auto& s = *inverse_scale_;
  auto n = static_cast<Eigen::Index>(rows_.size());
  if (known > 0 && n > known) {
    const auto L = L_.topLeftCorner(known, known).triangularView<Eigen::Lower>();
    for (Eigen::Index k = known; k < n; ++k) {
      const Eigen::Index row = rows_[k];
      auto cross = work_.head(known);
      for (Eigen::Index i = 0; i < known; ++i) {
        cross[i] = (*A_)(rows_[i], row) * s[rows_[i]] * s[row];
      }
      L.solveInPlace(cross);
      L_.row(k).head(known) = cross.transpose();
    }
  }
  bool all = true;
  for (Eigen::Index k = known; k < n;) {
    const Eigen::Index row = rows_[k];
    auto column = L_.col(k).segment(k, n - k);
    for (Eigen::Index i = k; i < n; ++i) {
      L_(i, k) = (*A_)(rows_[i], row) * s[rows_[i]] * s[row];
    }
    column.noalias() -= L_.block(k, 0, n - k, k) * L_.row(k).head(k).transpose();
    const double pivot = column[0];
    if (pivot > clear_pivot || (pivot > rank_threshold && pivot > pivot_rounding(k))) {
      column /= std::sqrt(pivot);
      held_[row] = 1;
      ++k;
    } else {
      refuse(k);
      --n;
      all = false;
    }
  }
  return all;
}

/// Rounding of the pivot at `position`. It is (e - r)' S A S (e - r) with r the shares of the rows
/// before it in this one: errors of the entries come in with |e - r|² in the 1-norm.
double ActiveSetFactor::pivot_rounding(Eigen::Index position) {
  auto shares = work_.head(position);
  shares = L_.row(position).head(position).transpose();
  L_.topLeftCorner(position, position)
      .triangularView<Eigen::Lower>()
      .transpose()
      .solveInPlace(shares);
  const double sum = 1 + shares.lpNorm<1>();
  return entry_rounding * sum * sum;
}

/// Takes the row at `position`, not yet factorised, out of the list.
void ActiveSetFactor::refuse(Eigen::Index position) {
  const auto last = static_cast<Eigen::Index>(rows_.size()) - 1;
  held_[rows_[position]] = 0;
  rows_.erase(rows_.begin() + position);
  for (Eigen::Index j = 0; j < position; ++j) {
    for (Eigen::Index i = position; i < last; ++i) {
      L_(i, j) = L_(i + 1, j);
    }
  }
}

Eigen::Ref<const Eigen::VectorXd> ActiveSetFactor::solve(
    const Eigen::Ref<const Eigen::VectorXd>& c) {
  const auto& s = *inverse_scale_;
  const auto n = static_cast<Eigen::Index>(rows_.size());
  auto y = work_.head(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] = c[rows_[i]] * s[rows_[i]];
  }
  const auto L = L_.topLeftCorner(n, n).triangularView<Eigen::Lower>();
  L.solveInPlace(y);
  L.transpose().solveInPlace(y);
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] *= s[rows_[i]];
  }
  return y;
}

}  // namespace hagfish
