// Ipopt (interior point, MUMPS) on the box QP: the primary, reference back end.
#pragma once

#include <memory>

#include "solvers/box_qp.hpp"

namespace hagfish {

/// Every number given to Ipopt, on the bounded part of the problem scaled to unit diagonal and
/// max |b̂| = 1, where all are without unit.
struct IpoptSettings {
  /// Ipopt stops at this error in w - z and in x z. `accepted` holds at this value even where
  /// crossover finds nothing better.
  double tolerance = 1e-9;
  /// This error in a first attempt whose point goes through crossover: near enough to tell which
  /// rows bind. Where it is not, by `accepted`, a second attempt stops at `tolerance`. Affects
  /// speed only.
  double polished_tolerance = 1e-4;
  /// Largest kkt_residuals of a point that is called solved.
  double accepted = 1e-8;
  /// Most iterations. Usually 3 to 10 are taken; 60 where rows are far from independent.
  int iteration_limit = 100;
  /// Barrier parameter of the start over its natural residual, and its least value. Smaller takes
  /// fewer iterations from good starts and more from bad ones.
  double barrier_share = 1e-4;
  double least_barrier = 1e-9;
  /// Number added to the diagonal while Ipopt runs, so that redundant rows do not let multipliers
  /// run away to infinity. Crossover works without it; where that finds nothing, w is off by this
  /// times ŷ.
  double regularisation = 1e-12;
  /// A problem whose objective falls below minus this is infeasible: it is ½ |v - v*|² in the H
  /// norm, over the change of velocity that the worst row alone needs; 5e7 is a change 1e4 times
  /// that large. Contradictions below 1e-3 of the worst row may come back as another failure.
  double infeasible_objective = 5e7;
  /// Bounds and right-hand sides beyond this are as good as infinite, until the answer shows that
  /// they are not.
  double far = 1e6;
  /// Whether crossover takes Ipopt's point to the vertex next to it. Off, the answer is Ipopt's
  /// own.
  bool polish = true;
  /// Working memory of MUMPS over its own estimate, %; it asks for more where this is too little.
  /// Ipopt's default of 1000 costs 15 % of the time in page faults.
  int mumps_extra_memory = 20;
};

/// Free rows are eliminated before (BoundedPart), what Ipopt solved is polished after (crossover),
/// and a point is called solved by its own residuals, not by Ipopt's word. Where Ipopt finds none,
/// pivoting from its point either does or names the rows that contradict each other. Reads no
/// option file.
class IpoptBoxQp final : public BoxQpSolver {
 public:
  explicit IpoptBoxQp(const IpoptSettings& settings = {});
  ~IpoptBoxQp() override;
  using BoxQpSolver::solve;
  void solve(const BoxQp& qp, const Eigen::VectorXd& start, BoxQpSolution& solution) override;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hagfish
