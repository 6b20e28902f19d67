// The solution of a QP in long double: what back ends' answers are measured against.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "solvers/box_qp.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

/// Distance of the velocity v = H⁻¹ (g + J' x) of an answer x from that of the solution x*. v is
/// unique where x is not.
struct VelocityError {
  double norm = 0;  ///< |v - v*| in the H norm: sqrt((x - x*)' A (x - x*))
  /// `norm` over the change |v* - H⁻¹ g| = sqrt(x*' A x*) or rhs_scale, whichever is larger: where
  /// rows hardly do anything, errors count as in kkt_residuals.
  double relative = 0;
  double largest = 0;           ///< |v - v*|∞; 0 where v is not known (BoxQp)
  double largest_relative = 0;  ///< `largest` over |v*|∞, or |v|∞ without rows where that is more
};

/// A problem, its elimination of v and its solution, all in long double (64 bits of mantissa on
/// x86). Keeps copies of what it needs.
class QpReference {
 public:
  /// Throws as check_box_qp does.
  explicit QpReference(const BoxQp& qp);
  /// Throws as dual_of does. Multipliers are those of G, then of C.
  explicit QpReference(const PrimalQp& qp);

  /// Looks for the solution from the sides on which `guess` (m) has its rows, by block pivoting
  /// with single changes where blocks do not get on (Júdice and Pires, Comput. Oper. Res. 1994).
  /// False where no point is found that solves the problem up to the rounding of its entries to
  /// double: rows contradict each other, or the guess is too poor for a singular A.
  bool solve(const Eigen::VectorXd& guess);

  /// Error of `x` (m) against the solution found; solve() must have returned true.
  VelocityError error(const Eigen::VectorXd& x) const;

 private:
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  enum class Side : unsigned char { active, lower, upper };  ///< active: w = A x - b = 0

  void scale(const BoxQp& qp);
  void solve_active();
  Real judge();
  Real norm(const Vector& y) const { return (half_ * y).norm(); }

  // Rows brought to unit diagonal: Â = S A S, b̂ = S b / β, x̂ = S⁻¹ x / β.
  Matrix A_;
  Matrix half_;  ///< Â = half' half up to rounding: norms by way of Â would lose half the digits
  Vector b_, lower_, upper_, scale_;
  Real beta_ = 1;
  Vector x_;
  std::vector<Side> side_;
  std::vector<std::pair<Eigen::Index, Side>> wrong_;  ///< rows and where they belong, ascending
  // With a primal problem: v = free_velocity_ + response_ x.
  Matrix response_;
  Vector free_velocity_;
};

}  // namespace hagfish
