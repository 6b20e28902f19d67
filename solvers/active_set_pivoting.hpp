// Pivoting finds which rows of a box QP rest on a bound and which have w = A x - b = 0.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "solvers/active_set_factor.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// Rows are active (x_i solves w_i = 0 together with the other active rows) or fixed (x_i stays).
/// A fixed row is at one of its bounds, at 0, or depends on the active rows.
/// Two ways to the solution, both also where A is singular, bounds are infinite or rows are free:
/// rows with a wrong sign change sides all at once, which is quick and may cycle, or one after the
/// other, which always ends.
class ActiveSetPivoting {
 public:
  enum class Ending { settled, contradiction, limit, stopped };

  /// `stop` is asked at each change whether to end.
  explicit ActiveSetPivoting(std::function<bool()> stop = [] { return false; })
      : stop_(std::move(stop)) {}
  ActiveSetPivoting(const ActiveSetPivoting&) = delete;  // its vectors refer to memory of its own
  ActiveSetPivoting& operator=(const ActiveSetPivoting&) = delete;

  /// Begins with `qp`, which must outlive the use, and every row fixed at 0.
  void start(const BoxQp& qp);
  /// Fixes row i at `value`, within its bounds.
  void fix(Eigen::Index i, double value) { x_[i] = value; }
  /// Makes row i active from change_blocks on, unless it depends on rows activated before: then it
  /// stays fixed.
  void activate(Eigen::Index i) { joining_.push_back(i); }

  /// Block principal pivoting (Portugal, Júdice, Vicente: A comparison of block pivoting and
  /// interior-point algorithms for linear least squares problems with nonnegative variables, Math.
  /// Comp. 1994). False where the number of wrong rows no longer falls, or where
  /// it is to stop.
  bool change_blocks();

  /// Primal active set method on x, which is the dual one of Goldfarb and Idnani (Math. Programming
  /// 1983) on velocities: the worst row joins, the active rows follow as far as their bounds allow,
  /// and those that meet a bound leave. The objective falls at every change, so that no set comes
  /// twice. A row that depends on the active ones takes the place of the one that blocks it; where
  /// none does, rows contradict each other.
  Ending change_singly();

  /// x, within the bounds after change_blocks returned true, and after change_singly.
  const Eigen::Map<Eigen::VectorXd>& x() const { return x_; }
  /// A x - b, to rounding, where x has settled.
  const Eigen::Map<Eigen::VectorXd>& w() const { return w_; }
  /// row_scale of the problem's A.
  const Eigen::Map<Eigen::VectorXd>& scale() const { return scale_; }
  /// Changes of sides so far, a block counting as one.
  int changes() const { return changes_; }
  /// Contradicting rows, ascending: Farkas' certificate. Multipliers t_i exist with Σ t_i A_i = 0
  /// and Σ t_i b_i > 0, and with no row left out. On rows without an upper bound t_i > 0; on free
  /// rows it has any sign.
  const std::vector<Eigen::Index>& contradicting() const { return contradicting_; }

 private:
  void update_gradient();
  int push(Eigen::Index i) const;
  bool solve_active();
  void clamp_active();
  void enter_box();
  Eigen::Index advance(double longest);
  bool descend();
  Eigen::Index worst_row() const;
  bool exchange(Eigen::Index row);

  std::function<bool()> stop_;
  const BoxQp* qp_ = nullptr;
  ActiveSetFactor factor_;
  Eigen::MatrixXd memory_;  ///< storage of the vectors below: Eigen's own allocate at each resize
  Eigen::Map<Eigen::VectorXd> scale_{nullptr, 0}, inverse_scale_{nullptr, 0}, x_{nullptr, 0},
      w_{nullptr, 0};
  Eigen::Map<Eigen::VectorXd> step_{nullptr, 0};       ///< step of the rows moving_, in their order
  Eigen::Map<Eigen::VectorXd> tolerated_{nullptr, 0};  ///< |ŵ| β up to which a row may go unmet
  Eigen::Map<Eigen::VectorXd> unsure_{nullptr, 0};     ///< rounding of b, brought to unit diagonal
  double beta_ = 1;                                    ///< size of b, brought to unit diagonal
  double noise_ = 0;                                   ///< rounding of w, brought to unit diagonal
  std::vector<Eigen::Index> moving_, leaving_, joining_, contradicting_;
  int changes_ = 0;
};

}  // namespace hagfish
