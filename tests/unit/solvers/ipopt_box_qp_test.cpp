// What is Ipopt's own; every_solver_test.cpp has what it shares with the other back ends.
#include "solvers/ipopt_box_qp.hpp"

#include <gtest/gtest.h>

#include "solvers/free_rows.hpp"
#include "tests/support/random_qp.hpp"

namespace hagfish::ipopt_box_qp_test {

BoxQpSolution solve_cold(const BoxQp& qp, const IpoptSettings& settings = {}) {
  return IpoptBoxQp(settings).solve(qp, Eigen::VectorXd::Zero(qp.b.size()));
}

TEST(IpoptBoxQp, FactorisesFreeRows) {
  std::mt19937 random(7);
  const KnownQp known = known_qp(random, 20, std::vector<Role>(15, Role::bilateral), 10);
  const BoxQpSolution solution = solve_cold(known.dual);
  ASSERT_EQ(solution.status, SolveStatus::solved);
  // The same factorisation of the same rows.
  EXPECT_EQ(solution.x, SemidefiniteFactor(known.dual.A).solve(known.dual.b));
}

TEST(IpoptBoxQp, SaysWhenItRunsOutOfIterations) {
  std::mt19937 random(11);
  const KnownQp known = known_qp(random, 60, each_role(6));
  IpoptSettings settings;
  settings.iteration_limit = 1;
  const BoxQpSolution solution = solve_cold(known.dual, settings);
  EXPECT_EQ(solution.status, SolveStatus::iteration_limit);
  EXPECT_TRUE(solution.x.allFinite());
}

TEST(IpoptBoxQp, ReturnsItsOwnPointUnpolished) {
  std::mt19937 random(23);
  const KnownQp known = known_qp(random, 60, each_role(6));
  IpoptSettings settings;
  settings.polish = false;
  const BoxQpSolution raw = solve_cold(known.dual, settings);
  ASSERT_EQ(raw.status, SolveStatus::solved) << raw.message;
  EXPECT_LE(kkt_residuals(known.dual, raw.x).worst(), settings.accepted);
  // An interior point stops inside: degenerate rows at the root of 1e-9, where polished ones are 0.
  const auto off = [&](const BoxQpSolution& s) {
    return (s.x - known.x).lpNorm<Eigen::Infinity>();
  };
  EXPECT_GT(off(raw), 1e-9);
  const BoxQpSolution polished = solve_cold(known.dual);
  EXPECT_LE(off(polished), 1e-12);
  EXPECT_LT(polished.iterations, raw.iterations);  // crossover ends what Ipopt need not
}

TEST(IpoptBoxQp, GoesTheCarefulWayWhereTheFastOneFails) {
  IpoptSettings settings;
  settings.barrier_share = settings.least_barrier = 1e-12;  // starts that are all but on the bounds
  settings.iteration_limit = 20;                            // of which the fast way takes more
  IpoptBoxQp solver(settings);
  std::mt19937 random(5);
  int careful = 0;
  for (int problem = 0; problem < 10; ++problem) {
    const KnownQp known = known_qp(random, 60, each_role(6));
    const BoxQpSolution solution = solver.solve(known.dual, Eigen::VectorXd::Zero(known.x.size()));
    ASSERT_EQ(solution.status, SolveStatus::solved) << solution.message;
    EXPECT_LE((solution.x - known.x).lpNorm<Eigen::Infinity>(), 1e-12);
    careful += solution.iterations > settings.iteration_limit ? 1 : 0;
  }
  EXPECT_GT(careful, 0);
}

}  // namespace hagfish::ipopt_box_qp_test
