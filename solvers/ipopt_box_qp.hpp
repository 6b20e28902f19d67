// Ipopt (interior point, MUMPS) on the box QP: the primary, reference back end.
#pragma once

#include <memory>

#include "solvers/box_qp.hpp"

namespace hagfish {

/// Every number given to Ipopt, on the problem scaled to unit diagonal and |b̂| <= 1, where all are
/// without unit.
struct IpoptSettings {
  /// Ipopt stops at this scaled error; kkt_residuals then comes out below 1e-8.
  double tolerance = 1e-10;
  int iteration_limit = 200;
  /// Distance that a warm start keeps from its bounds, and the barrier that goes with it.
  double warm_push = 1e-4;
  double warm_mu = 1e-6;
};

class IpoptBoxQp final : public BoxQpSolver {
 public:
  explicit IpoptBoxQp(const IpoptSettings& settings = {});
  ~IpoptBoxQp() override;
  BoxQpSolution solve(const BoxQp& qp, const Eigen::VectorXd& start) override;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hagfish
