#include "solvers/active_set_pivoting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of the sum of what adds up to w_i, brought to unit diagonal: |ŵ_i| below it is rounding.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
/// Of block pivoting: changes without fewer wrong rows before it gives up. Portugal et al. take 10;
/// single changes follow here, which need no patience.
constexpr int patience = 3;
/// Rows that depend on each other with shares t_i (brought to unit diagonal) miss by about 1e-14 of
/// β Σ |t_i| where they agree, and by the rounding of b; rows that contradict each other miss by
/// more than this and that rounding.
constexpr double consistency = 1e-9;
/// Smaller shares in a dependent row are rounding: the root of the factor's rank threshold, as the
/// row would depend on the others alone to the square of such a share.
constexpr double least_share = 1e-6;
/// Columns of A that go into w together, so that w is read and written less often.
constexpr int columns_at_once = 4;

/// w += Σ x_j A_j over `columns` j, summed in their order.
void add_columns(const Eigen::MatrixXd& A, const std::array<Eigen::Index, columns_at_once>& columns,
                 const Eigen::Map<Eigen::VectorXd>& x, Eigen::Map<Eigen::VectorXd>& w) {
  const auto [j0, j1, j2, j3] = columns;
  const double x0 = x[j0], x1 = x[j1], x2 = x[j2], x3 = x[j3];
  const double *a0 = A.col(j0).data(), *a1 = A.col(j1).data(), *a2 = A.col(j2).data(),
               *a3 = A.col(j3).data();
  double* __restrict sum = w.data();
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    sum[i] = (((sum[i] + x0 * a0[i]) + x1 * a1[i]) + x2 * a2[i]) + x3 * a3[i];
  }
}

}  // namespace

void ActiveSetPivoting::start(const BoxQp& qp) {
  const Eigen::Index m = qp.b.size();
  qp_ = &qp;
  if (memory_.rows() < m || memory_.cols() == 0) {
    memory_.resize(m, 7);
    for (std::vector<Eigen::Index>* rows : {&moving_, &leaving_, &joining_, &contradicting_}) {
      rows->reserve(m);
    }
  }
  Eigen::Index column = 0;
  for (Eigen::Map<Eigen::VectorXd>* vector :
       {&scale_, &inverse_scale_, &x_, &w_, &step_, &tolerated_, &unsure_}) {
    new (vector) Eigen::Map<Eigen::VectorXd>(memory_.col(column++).data(), m);
  }
  row_scale(qp.A, scale_);
  inverse_scale_ = scale_.cwiseInverse();
  beta_ = rhs_scale(qp, scale_);
  x_.setZero();
  joining_.clear();
  contradicting_.clear();
  tolerated_.setZero();
  if (qp.rounding.size() == m) {
    unsure_ = qp.rounding.cwiseProduct(inverse_scale_);
  } else {
    unsure_.setZero();
  }
  changes_ = 0;
  factor_.reset(qp.A, inverse_scale_);
}

void ActiveSetPivoting::update_gradient() {
  w_ = -qp_->b;
  double sum = beta_;
  std::array<Eigen::Index, columns_at_once> columns{};
  std::size_t waiting = 0;
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    if (x_[j] != 0) {
      sum += std::abs(x_[j]) * scale_[j];
      columns[waiting++] = j;
      if (waiting == columns.size()) {
        add_columns(qp_->A, columns, x_, w_);
        waiting = 0;
      }
    }
  }
  for (std::size_t k = 0; k < waiting; ++k) w_ += x_[columns[k]] * qp_->A.col(columns[k]);
  noise_ = rounding * sum;
}

/// +1 or -1 where the sign of w moves row i off the place where it is fixed, else 0.
int ActiveSetPivoting::push(Eigen::Index i) const {
  const double w = w_[i] * inverse_scale_[i];
  const double noise = noise_ + unsure_[i];
  if (w < -noise) return x_[i] < qp_->upper[i] ? 1 : 0;
  return w > noise && x_[i] > qp_->lower[i] ? -1 : 0;
}

/// Corrects x of the active rows so that their w vanishes; w is up to date before and after.
/// Whether it came from far beyond where it is now: then its rounding is that of what it was.
bool ActiveSetPivoting::solve_active() {
  const auto change = factor_.solve(w_);
  double most_moved = 0;
  double largest = 0;
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const Eigen::Index i = factor_.rows()[k];
    x_[i] -= change[k];
    most_moved = std::max(most_moved, std::abs(change[k]) * scale_[i]);
    largest = std::max(largest, std::abs(x_[i]) * scale_[i]);
  }
  update_gradient();
  return most_moved > 2 * largest;
}

void ActiveSetPivoting::clamp_active() {
  bool moved = false;
  for (const Eigen::Index i : factor_.rows()) {
    const double before = x_[i];
    x_[i] = std::clamp(before, qp_->lower[i], qp_->upper[i]);
    moved = moved || x_[i] != before;
  }
  if (moved) update_gradient();
}

bool ActiveSetPivoting::change_blocks() {
  factor_.append(joining_);
  update_gradient();
  std::size_t fewest = x_.size() + 1;
  for (int tries = patience;; ++changes_) {
    const bool from_far = solve_active();
    leaving_.clear();
    joining_.clear();
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (factor_.contains(i)) {
        if (x_[i] < qp_->lower[i] || x_[i] > qp_->upper[i]) leaving_.push_back(i);
      } else if (push(i) != 0) {
        joining_.push_back(i);
      }
    }
    const std::size_t wrong = leaving_.size() + joining_.size();
    if (wrong == 0) {
      if (from_far) solve_active();
      clamp_active();
      return true;
    }
    if (wrong < fewest) {
      fewest = wrong;
      tries = patience;
    } else if (tries-- == 0) {
      return false;
    }
    if (stop_()) return false;
    for (const Eigen::Index i : leaving_) {
      const double bound = std::clamp(x_[i], qp_->lower[i], qp_->upper[i]);
      w_ += (bound - x_[i]) * qp_->A.col(i);
      x_[i] = bound;
    }
    factor_.change(leaving_, joining_);
  }
}

/// Fixes active rows that are not between their bounds at the nearer one.
void ActiveSetPivoting::enter_box() {
  leaving_.clear();
  for (const Eigen::Index i : factor_.rows()) {
    if (x_[i] <= qp_->lower[i] || x_[i] >= qp_->upper[i]) leaving_.push_back(i);
  }
  clamp_active();
  factor_.remove(leaving_);
}

ActiveSetPivoting::Ending ActiveSetPivoting::change_singly() {
  enter_box();
  const auto most = 100 + 20 * static_cast<int>(x_.size());
  for (int k = 0; k < most; ++k) {
    if (stop_()) return Ending::stopped;
    update_gradient();
    if (!descend()) continue;
    const Eigen::Index row = worst_row();
    if (row < 0) {
      solve_active();
      clamp_active();
      return Ending::settled;
    }
    ++changes_;
    if (!factor_.append({&row, 1}) && !exchange(row)) return Ending::contradiction;
  }
  return Ending::limit;
}

/// One Newton step of the active rows, cut where it meets a bound; true where it meets none.
bool ActiveSetPivoting::descend() {
  const auto change = factor_.solve(w_);
  moving_ = factor_.rows();
  step_.head(change.size()) = -change;
  const Eigen::Index blocking = advance(1);
  if (blocking >= 0) {
    factor_.remove({&blocking, 1});
    return false;
  }
  update_gradient();
  return true;
}

/// Moves x of moving_ by t step_, t <= `longest`, as far as the bounds allow. Returns the row that
/// blocks, -1 where none does; x stays where t would be infinite.
Eigen::Index ActiveSetPivoting::advance(double longest) {
  std::size_t first = moving_.size();
  double t = longest;
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const Eigen::Index i = moving_[k];
    const double rate = step_[k];
    const double room = rate > 0 ? qp_->upper[i] - x_[i] : qp_->lower[i] - x_[i];
    if (rate != 0 && room / rate < t) {
      t = room / rate;
      first = k;
    }
  }
  if (std::isinf(t)) return -1;
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const Eigen::Index i = moving_[k];
    x_[i] = std::clamp(x_[i] + t * step_[k], qp_->lower[i], qp_->upper[i]);
  }
  if (first == moving_.size()) return -1;
  const Eigen::Index blocking = moving_[first];
  x_[blocking] = step_[first] > 0 ? qp_->upper[blocking] : qp_->lower[blocking];  // to the last bit
  return blocking;
}

/// The fixed row with the largest |ŵ| of a wrong sign, -1 where there is none.
Eigen::Index ActiveSetPivoting::worst_row() const {
  Eigen::Index worst = -1;
  double most = 0;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double size = std::abs(w_[i]) * inverse_scale_[i];
    if (size > most && !factor_.contains(i) && push(i) != 0 && size > tolerated_[i]) {
      worst = i;
      most = size;
    }
  }
  return worst;
}

/// Moves along the ray on which `row`, which depends on the active rows, changes no velocity, and
/// lets it take the place of the row that blocks. False where nothing blocks and `row` is missed by
/// more than rounding.
bool ActiveSetPivoting::exchange(Eigen::Index row) {
  // Along the ray A x stays as it is, and the active rows have w = 0. So the objective falls by |w|
  // of `row` all the way to a bound. Without a bound it falls for ever: the rows contradict each
  // other, and those on the ray are the proof (Farkas).
  const auto share = factor_.solve(qp_->A.col(row));
  const int sign = push(row);
  moving_ = factor_.rows();
  step_.head(share.size()) = -sign * share;
  double sum = 1;
  double unsure = unsure_[row];
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const double part = std::abs(step_[k]) * scale_[moving_[k]] * inverse_scale_[row];
    sum += part;
    unsure += part * unsure_[moving_[k]];
    if (part <= least_share) step_[k] = 0;
  }
  const double size = std::abs(w_[row]) * inverse_scale_[row];
  // w of `row` is the same sum of the active rows' w, so that it has the sum of their rounding. A
  // row that is off by no more is met: to choose it again would lead back here.
  tolerated_[row] = noise_ * sum + unsure;
  if (size <= tolerated_[row]) return true;
  step_[share.size()] = sign;
  moving_.push_back(row);
  const Eigen::Index blocking = advance(infinity);
  if (blocking < 0) {
    tolerated_[row] = consistency * beta_ * sum + unsure;
    if (size <= tolerated_[row]) return true;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (step_[k] != 0) contradicting_.push_back(moving_[k]);
    }
    std::sort(contradicting_.begin(), contradicting_.end());
    return false;
  }
  if (blocking != row) {
    factor_.remove({&blocking, 1});
    factor_.append({&row, 1});
  }
  return true;
}

}  // namespace hagfish
