#include "solvers/active_set_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solvers/tile_product.hpp"

namespace hagfish {
namespace {

/// As in free_rows.cpp: smaller pivots of a matrix of unit diagonal are rounding.
constexpr double rank_threshold = 1e-12;
/// Pivots above this are not: they are clear of rounding without a closer look.
constexpr double clear_pivot = 1e-4;
/// Rounding of A and of the factor, in entries of A brought to unit diagonal.
constexpr double entry_rounding = 8 * std::numeric_limits<double>::epsilon();

using Lanes = Eigen::Array<double, tile_rows, 1>;
using ConstLanes = Eigen::Map<const Lanes, Eigen::Aligned16>;

/// t := t L⁻ᵀ with the diagonal tile L of a panel and its inverse pivots.
void solve_tile(const double* diagonal, const double* inverse_pivot, Tile& t) {
  for (Eigen::Index first = 0; first < tile_rows; first += tile_part) {
    Eigen::Array<double, tile_part, tile_rows> part = t.middleRows<tile_part>(first);
#pragma GCC unroll 8
    for (int j = 0; j < tile_rows; ++j) {
      part.col(j) *= inverse_pivot[j];
#pragma GCC unroll 8
      for (int i = j + 1; i < tile_rows; ++i) {
        part.col(i) -= part.col(j) * diagonal[tile_rows * j + i];
      }
    }
    t.middleRows<tile_part>(first) = part;
  }
}

}  // namespace

/// The tile_rows entries of column `k` in panel `p`.
double* ActiveSetFactor::column(Eigen::Index p, Eigen::Index k) {
  return L_.data() + tile_rows * (tile_rows * p * (p + 1) / 2 + k);
}

void ActiveSetFactor::reset(const Eigen::MatrixXd& A,
                            const Eigen::Map<Eigen::VectorXd>& inverse_scale) {
  const Eigen::Index m = A.rows();
  A_ = &A;
  inverse_scale_ = &inverse_scale;
  const Eigen::Index panels = (m + tile_rows - 1) / tile_rows;
  if (inverse_pivot_.size() < panels * tile_rows) {
    L_.setZero(tile_rows * tile_rows * panels * (panels + 1) / 2);
    inverse_pivot_.setZero(panels * tile_rows);
    work_.setZero(panels * tile_rows);
    sums_.resize(tile_rows * panels * tile_rows);
    rows_.reserve(m);
  }
  rows_.clear();
  active_.assign(m, 0);
}

bool ActiveSetFactor::change(std::span<const Eigen::Index> dropped,
                             std::span<const Eigen::Index> added) {
  for (const Eigen::Index row : dropped) active_[row] = 0;
  const auto gone = [this](Eigen::Index row) { return active_[row] == 0; };
  const auto first = dropped.empty() ? rows_.end() : std::find_if(rows_.begin(), rows_.end(), gone);
  const auto known = first - rows_.begin();
  rows_.erase(std::remove_if(first, rows_.end(), gone), rows_.end());
  rows_.insert(rows_.end(), added.begin(), added.end());
  return known == std::ssize(rows_) || factorise_from(known);
}

/// Factorises rows_ from `position` on. A panel of which some rows are known is made again: its
/// rows take no longer together than one of them.
bool ActiveSetFactor::factorise_from(Eigen::Index position) {
  bool all = true;
  for (Eigen::Index p = position / tile_rows; p * tile_rows < std::ssize(rows_);) {
    const Eigen::Index refused = make_panel(p);
    if (refused < 0) {
      ++p;
    } else {
      active_[rows_[refused]] = 0;
      rows_.erase(rows_.begin() + refused);
      all = false;
    }
  }
  return all;
}

/// Makes panel `p`. Returns the position of a row that depends on those before it, with which the
/// panel ends; -1 where there is none.
Eigen::Index ActiveSetFactor::make_panel(Eigen::Index p) {
  gather(p);
  for (Eigen::Index q = 0; q <= p; ++q) {
    Eigen::Map<Tile> made(column(p, q * tile_rows));
    Tile t = made;
    t -= tile_product(column(p, 0), tile_rows, column(q, 0), tile_rows, q * tile_rows);
    if (q < p) solve_tile(column(q, q * tile_rows), &inverse_pivot_[q * tile_rows], t);
    made = t;
  }
  return make_diagonal(p);
}

/// Sets panel `p` to entries of A, brought to unit diagonal; to 0 behind the last row.
void ActiveSetFactor::gather(Eigen::Index p) {
  const Eigen::Index first = p * tile_rows;
  const Eigen::Index n = std::ssize(rows_);
  const auto row = [&](Eigen::Index k) { return k < n ? rows_[k] : 0; };
  const auto scale = [&](Eigen::Index k) { return k < n ? (*inverse_scale_)[rows_[k]] : 0; };
  std::array<const double*, tile_rows> entries;  // A is symmetric: its columns are its rows
  Lanes scales;
  for (Eigen::Index i = 0; i < tile_rows; ++i) {
    entries[i] = A_->col(row(first + i)).data();
    scales[i] = scale(first + i);
  }
  double* l = column(p, 0);
  for (Eigen::Index k = 0; k < first + tile_rows; ++k, l += tile_rows) {
    for (Eigen::Index i = 0; i < tile_rows; ++i) l[i] = entries[i][row(k)];
  }
  l = column(p, 0);
  for (Eigen::Index k = 0; k < first + tile_rows; ++k, l += tile_rows) {
    Eigen::Map<Lanes, Eigen::Aligned16>(l) *= scales * scale(k);
  }
}

/// Factorises the diagonal tile of panel `p` in its place. Returns as make_panel does.
Eigen::Index ActiveSetFactor::make_diagonal(Eigen::Index p) {
  const Eigen::Index first = p * tile_rows;
  const Eigen::Index count = std::min<Eigen::Index>(tile_rows, std::ssize(rows_) - first);
  Eigen::Map<Tile> t(column(p, first));
  for (Eigen::Index j = 0; j < count; ++j) {
    if (!accept(t(j, j), first + j)) return first + j;
    inverse_pivot_[first + j] = 1 / std::sqrt(t(j, j));
    const Lanes l = t.col(j) * inverse_pivot_[first + j];
    t.col(j) = l;
#pragma GCC unroll 8
    for (Eigen::Index i = 0; i < tile_rows; ++i) {
      if (i > j) t.col(i) -= l * l[i];
    }
    active_[rows_[first + j]] = 1;
  }
  return -1;
}

/// Whether the row at `position` does not depend on those before it.
bool ActiveSetFactor::accept(double pivot, Eigen::Index position) {
  return pivot > clear_pivot || (pivot > rank_threshold && pivot > pivot_rounding(position));
}

/// Rounding of the pivot at `position`. It is (e - r)' S A S (e - r) with r the shares of the rows
/// before it in this one: errors of the entries come in with |e - r|² in the 1-norm.
double ActiveSetFactor::pivot_rounding(Eigen::Index position) {
  const Eigen::Index p = position / tile_rows;
  for (Eigen::Index k = 0; k < position; ++k) work_[k] = column(p, k)[position % tile_rows];
  solve_upper(position);
  const double sum = 1 + work_.head(position).lpNorm<1>();
  return entry_rounding * sum * sum;
}

Eigen::Ref<const Eigen::VectorXd> ActiveSetFactor::solve(
    const Eigen::Ref<const Eigen::VectorXd>& c) {
  const auto& s = *inverse_scale_;
  const Eigen::Index n = std::ssize(rows_);
  for (Eigen::Index i = 0; i < n; ++i) work_[i] = c[rows_[i]] * s[rows_[i]];
  solve_lower(n);
  solve_upper(n);
  for (Eigen::Index i = 0; i < n; ++i) work_[i] *= s[rows_[i]];
  return work_.head(n);
}

/// work_ := L⁻¹ work_, of `n` rows. What stands behind them to the end of a panel is lost.
void ActiveSetFactor::solve_lower(Eigen::Index n) {
  for (Eigen::Index first = 0; first < n; first += tile_rows) {
    const double* l = column(first / tile_rows, 0);
    Eigen::Array<double, tile_rows, 4> sums;  // apart, as each addition waits for the one before
    sums.setZero();
    for (Eigen::Index k = 0; k < first; k += 4, l += 4 * tile_rows) {
      for (int j = 0; j < 4; ++j) sums.col(j) += ConstLanes(l + tile_rows * j) * work_[k + j];
    }
    Eigen::Map<Lanes> y(&work_[first]);
    y -= (sums.col(0) + sums.col(1)) + (sums.col(2) + sums.col(3));
    std::array<double, tile_rows> left;
    Eigen::Map<Lanes>(left.data()) = y;
#pragma GCC unroll 8
    for (Eigen::Index j = 0; j < tile_rows; ++j) {
      left[j] *= inverse_pivot_[first + j];
#pragma GCC unroll 8
      for (Eigen::Index i = j + 1; i < tile_rows; ++i) left[i] -= l[tile_rows * j + i] * left[j];
    }
    y = Eigen::Map<Lanes>(left.data());
  }
}

/// work_ := L⁻ᵀ work_, of `n` rows.
void ActiveSetFactor::solve_upper(Eigen::Index n) {
  const Eigen::Index panels = (n + tile_rows - 1) / tile_rows;
  work_.segment(n, panels * tile_rows - n).setZero();
  Eigen::Map<Eigen::Array<double, tile_rows, Eigen::Dynamic>> sums(sums_.data(), tile_rows,
                                                                   panels * tile_rows);
  sums.setZero();
  for (Eigen::Index p = panels; p-- > 0;) {
    const Eigen::Index first = p * tile_rows;
    const double* diagonal = column(p, first);
    Eigen::Map<Lanes> y(&work_[first]);
    y -= sums.middleCols<tile_rows>(first).colwise().sum().transpose();
    std::array<double, tile_rows> left;
    Eigen::Map<Lanes>(left.data()) = y;
#pragma GCC unroll 8
    for (Eigen::Index j = tile_rows; j-- > 0;) {
      left[j] *= inverse_pivot_[first + j];
#pragma GCC unroll 8
      for (Eigen::Index i = 0; i < j; ++i) left[i] -= diagonal[tile_rows * i + j] * left[j];
    }
    y = Eigen::Map<Lanes>(left.data());
    const Lanes found = y;
    const double* l = column(p, 0);
    for (Eigen::Index k = 0; k < first; ++k, l += tile_rows) sums.col(k) += ConstLanes(l) * found;
  }
}

}  // namespace hagfish
