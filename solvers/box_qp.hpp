// The quadratic program of one step, in its multipliers:
//
//     minimise  ½ x' A x - b' x   subject to   l <= x <= u.
//
// It is the dual of  min ½ v' H v - g' v,  C v >= d  with A = C H⁻¹ C', b = d - C H⁻¹ g and
// v = H⁻¹ (g + C' x). Sign convention, the only one here: stationarity of the primal reads
// H v - g - C' x = 0 with x >= 0 on unilateral rows, so C' x is what the constraints add to g.
// The gradient w = A x - b equals C v - d: a unilateral row's excess of velocity.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hagfish {

struct BoxQp {
  Eigen::MatrixXd A;      ///< m x m, symmetric, positive semidefinite, may be singular
  Eigen::VectorXd b;      ///< m
  Eigen::VectorXd lower;  ///< m, <= 0, -infinity where free
  Eigen::VectorXd upper;  ///< m, >= 0, +infinity where free
  /// Rounding of b, m, or empty where b is exact: b_i is a difference of larger numbers and known
  /// to this alone. Rows that miss by no more are met.
  Eigen::VectorXd rounding = {};
};

/// Throws std::invalid_argument with the cause in one line where sizes differ, A or b is not finite
/// or a box leaves out 0.
void check_box_qp(const BoxQp& qp);

/// What b_i may be off.
inline double b_rounding(const BoxQp& qp, Eigen::Index i) {
  return qp.rounding.size() == 0 ? 0 : qp.rounding[i];
}

/// Whether b violates row i at x = 0 by more than its rounding, with room to the bound on its side.
inline bool pushes_at_zero(const BoxQp& qp, Eigen::Index i) {
  const double b = qp.b[i];
  return (b > 0 ? qp.upper[i] > 0 : qp.lower[i] < 0) && (b > 0 ? b : -b) > b_rounding(qp, i);
}

/// sqrt(A_ii), m: what brings rows of different units to unit diagonal. A row below 1e-20 of the
/// largest cannot move: its scale is 1e-10 of the largest (1 where A = 0).
Eigen::VectorXd row_scale(const Eigen::MatrixXd& A);
/// Writes the same scale into memory of the caller's, `s` (m).
void row_scale(const Eigen::MatrixXd& A, Eigen::Ref<Eigen::VectorXd> s);

/// β = max |b_i| / s_i over rows that can move and that push at x = 0; 1 where there is none. The b
/// of a row that is met says nothing of the size of x and may be a stand-in for infinity. `s` is
/// row_scale(A).
double rhs_scale(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& s);

enum class SolveStatus { solved, infeasible, iteration_limit, stopped, failed };
/// Names in the order of the enumeration.
inline constexpr std::array status_names = {"solved", "infeasible", "iteration limit", "stopped",
                                            "failed"};
inline const char* status_name(SolveStatus status) {
  return status_names[static_cast<std::size_t>(status)];
}

struct BoxQpSolution {
  Eigen::VectorXd x;  ///< m; within the bounds and finite also where the solve failed
  SolveStatus status = SolveStatus::failed;
  int iterations = 0;
  std::string message;  ///< the back end's own word where it failed
  /// Rows that cannot be met together, rising, if the problem is infeasible. Empty where the back
  /// end does not know them.
  std::vector<Eigen::Index> contradicting;
};

/// Scaled infinity norms; 0 at an exact solution. Rows are brought to unit diagonal first:
/// x̂_i = x_i s_i / β, ŵ_i = w_i / (s_i β) with s = row_scale(A) and β = rhs_scale.
struct KktResiduals {
  /// max |ŵ_i| of rows with nothing to push against (w > 0 without a lower bound, w < 0 without an
  /// upper one), and how far any x̂_i lies outside its bounds.
  double primal = 0;
  /// max of |ŵ_i| times the distance of x̂_i from the finite bound that w pushes it to, at most
  /// |x̂_i| or 1: bounds that are further away are as good as none.
  double complementarity = 0;
  double worst() const { return primal > complementarity ? primal : complementarity; }
};

/// Residuals of any x against the problem; knows no back end. Infinite where x or w is not finite.
KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x);

/// Residuals from w = C v - d as measured on the primal side instead of A x - b, with s =
/// row_scale(A). β is at least `least_beta`: of a larger problem of which this one is a part.
KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Eigen::Ref<const Eigen::VectorXd>& w,
                           const Eigen::Ref<const Eigen::VectorXd>& s, double least_beta = 0);

/// A back end. Solvers keep settings and scratch, never results: the same problem and start give
/// the same answer.
class BoxQpSolver {
 public:
  virtual ~BoxQpSolver() = default;
  /// A solve ends, with SolveStatus::stopped, soon after `asked` returns true: it is called at each
  /// iteration. Never, where it is empty.
  void stop_when(std::function<bool()> asked) { stop_ = std::move(asked); }
  /// `start` (m) is a guess at x, zero where nothing is known. `solution` is written whole, into
  /// the storage that it has. Throws as check_box_qp does.
  virtual void solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) = 0;
  BoxQpSolution solve(const BoxQp& qp, const Eigen::VectorXd& start) {
    BoxQpSolution solution;
    solve(qp, start, solution);
    return solution;
  }

 protected:
  bool stopped() const { return stop_ && stop_(); }

 private:
  std::function<bool()> stop_;
};

/// Names that make_box_qp_solver takes.
std::vector<std::string> box_qp_solver_names();

/// Throws std::invalid_argument naming the known back ends where `name` is none of them.
std::unique_ptr<BoxQpSolver> make_box_qp_solver(const std::string& name);

}  // namespace hagfish
