#include "solvers/active_set_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/tile_product.hpp"

namespace hagfish {
namespace {

constexpr int panel = 4;  // columns made together
/// As in free_rows.cpp: smaller pivots of a matrix of unit diagonal are rounding.
constexpr double rank_threshold = 1e-12;
/// Pivots above this are not: they are clear of rounding without a closer look.
constexpr double clear_pivot = 1e-4;
/// Rounding of A and of the factor, in entries of A brought to unit diagonal.
constexpr double entry_rounding = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

void ActiveSetFactor::reset(const Eigen::MatrixXd& A,
                            const Eigen::Map<Eigen::VectorXd>& inverse_scale) {
  const Eigen::Index m = A.rows();
  A_ = &A;
  inverse_scale_ = &inverse_scale;
  if (L_.cols() < m || L_.cols() == 0) {
    L_.setZero(m + tile_rows, m);
    work_.resize(m);
    rows_.reserve(m);
  }
  rows_.clear();
  active_.assign(m, 0);
}

bool ActiveSetFactor::append(std::span<const Eigen::Index> added) {
  const auto known = static_cast<Eigen::Index>(rows_.size());
  rows_.insert(rows_.end(), added.begin(), added.end());
  return factorise_tail(known);
}

void ActiveSetFactor::remove(std::span<const Eigen::Index> dropped) {
  for (const Eigen::Index row : dropped) {
    active_[row] = 0;
  }
  const auto gone = [this](Eigen::Index row) { return active_[row] == 0; };
  const auto first = std::find_if(rows_.begin(), rows_.end(), gone);
  const auto known = first - rows_.begin();
  rows_.erase(std::remove_if(first, rows_.end(), gone), rows_.end());
  factorise_tail(known);
}

/// Factorises rows_ from position `known` on, panel by panel of columns.
bool ActiveSetFactor::factorise_tail(Eigen::Index known) {
  auto n = static_cast<Eigen::Index>(rows_.size());
  bool all = true;
  for (Eigen::Index first = 0; known < n && first < n;) {
    // Columns that are final already gain the new rows only.
    const bool final = first < known;
    const Eigen::Index top = final ? known : first;
    const Eigen::Index width = std::min<Eigen::Index>(panel, (final ? known : n) - first);
    start_panel(first, width, top, n);
    Eigen::Index k = first;
    for (; k < first + width && (final || accept(k)); ++k) {
      const Eigen::Index from = final ? known : k + 1;
      auto column = L_.col(k).segment(from, n - from);
      column /= L_(k, k);
      for (Eigen::Index j = k + 1; j < first + width; ++j) {
        const Eigen::Index behind = std::max(top, j);
        L_.col(j).segment(behind, n - behind) -= L_(j, k) * column.tail(n - behind);
      }
    }
    if (k < first + width) {  // the columns behind it are made again
      refuse(k);
      --n;
      all = false;
    }
    first = k;
  }
  return all;
}

/// Sets `width` columns from `first` on, rows `top` to n, to what the columns before them leave of
/// A, on and below the diagonal.
void ActiveSetFactor::start_panel(Eigen::Index first, Eigen::Index width, Eigen::Index top,
                                  Eigen::Index n) {
  const auto& s = *inverse_scale_;
  for (Eigen::Index k = first; k < first + width; ++k) {
    for (Eigen::Index i = std::max(top, k); i < n; ++i) {
      L_(i, k) = (*A_)(rows_[i], rows_[k]) * s[rows_[i]] * s[rows_[k]];
    }
  }
  for (Eigen::Index i = top; first > 0 && i < n; i += tile_rows) {
    const auto tile =
        tile_product<panel>(&L_(i, 0), L_.outerStride(), &L_(first, 0), L_.outerStride(), first);
    const Eigen::Index rows = std::min(tile_rows, n - i);
    L_.block(i, first, rows, width).array() -= tile.topLeftCorner(rows, width);
  }
}

/// Makes the pivot at `k` final unless its row depends on those before it.
bool ActiveSetFactor::accept(Eigen::Index k) {
  const double pivot = L_(k, k);
  if (pivot <= clear_pivot && (pivot <= rank_threshold || pivot <= pivot_rounding(k))) {
    return false;
  }
  L_(k, k) = std::sqrt(pivot);
  active_[rows_[k]] = 1;
  return true;
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
  active_[rows_[position]] = 0;
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
