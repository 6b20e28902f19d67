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
#include <memory>
#include <string>
#include <vector>

namespace hagfish {

struct BoxQp {
  Eigen::MatrixXd A;      ///< m x m, symmetric, positive semidefinite, may be singular
  Eigen::VectorXd b;      ///< m
  Eigen::VectorXd lower;  ///< m, -infinity where free
  Eigen::VectorXd upper;  ///< m, +infinity where free
};

enum class SolveStatus { solved, infeasible, iteration_limit, failed };
const char* status_name(SolveStatus status);

struct BoxQpSolution {
  Eigen::VectorXd x;  ///< m; within the bounds also where the solve failed
  SolveStatus status = SolveStatus::failed;
  int iterations = 0;
  std::string message;  ///< the back end's own word where it failed
};

/// Scaled infinity norms; 0 at an exact solution. Rows are brought to unit diagonal first:
/// x̂_i = x_i s_i, ŵ_i = w_i / s_i with s_i = sqrt(A_ii), and β = max_i |b_i| / s_i is the scale of
/// both.
struct KktResiduals {
  /// max |ŵ_i| / β over rows that may move both ways (strictly inside their bounds by more than
  /// the complementarity measure can tell), and the wrong-way part of ŵ at rows on a bound.
  double primal = 0;
  double complementarity = 0;  ///< max of |x̂_i - bound| |ŵ_i| / β² against the nearer bound
  double worst() const { return primal > complementarity ? primal : complementarity; }
};

/// Residuals of any x against the problem; knows no back end. Unilateral rows (u = inf) count a
/// negative ŵ as primal error, free rows |ŵ|; a row soft from above (finite u) may have ŵ < 0 at
/// u. Products x̂ ŵ are complementarity error.
KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x);

/// The same from w = C v - d as measured on the primal side instead of A x - b.
KktResiduals kkt_residuals(const BoxQp& qp, const Eigen::VectorXd& x, const Eigen::VectorXd& w);

/// A back end. Solvers keep settings and scratch, never results: the same problem and start give
/// the same answer.
class BoxQpSolver {
 public:
  virtual ~BoxQpSolver() = default;
  /// `start` (m) is a guess at x, zero where nothing is known.
  virtual BoxQpSolution solve(const BoxQp& qp, const Eigen::VectorXd& start) = 0;
};

/// Names that make_box_qp_solver takes.
std::vector<std::string> box_qp_solver_names();

/// Throws std::invalid_argument naming the known back ends where `name` is none of them.
std::unique_ptr<BoxQpSolver> make_box_qp_solver(const std::string& name);

/// The all-free limit l = -inf, u = inf (paper, Eq. 3 after elimination of q̇): A x = b, by a
/// rank-revealing factorisation; redundant rows share their force. Status infeasible where
/// A x = b has no solution to rounding.
BoxQpSolution solve_bilateral(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace hagfish
