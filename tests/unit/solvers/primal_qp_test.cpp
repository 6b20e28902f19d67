#include "tests/support/primal_reference.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/random_qp.hpp"

namespace hagfish::primal_qp_test {

/// Of v where no row is degenerate: Ipopt's 1e-14 times a condition of about 100.
constexpr double sharp = 1e-11;
/// Of v where a row has neither force nor excess: the square root of Ipopt's 1e-14, and a digit.
constexpr double degenerate = 1e-6;
/// Solutions count as solved below this residual, the sum of rounding and Ipopt's own tolerance.
constexpr double accepted = 1e-11;

const std::vector<Role> sharp_roles = {Role::bilateral, Role::bilateral, Role::active, Role::active,
                                       Role::inactive,  Role::inactive,  Role::soft,   Role::soft,
                                       Role::at_cap,    Role::at_cap};

double multiplier_error(const KnownQp& known, const PrimalQpSolution& solution) {
  Eigen::VectorXd x(known.x.size());
  x << solution.mu, solution.lambda;
  return (x - known.x).cwiseProduct(row_scale(known.dual.A)).lpNorm<Eigen::Infinity>();
}

Eigen::VectorXd by_dual(const KnownQp& known) {
  const auto solver = make_box_qp_solver("ipopt");
  const BoxQpSolution solution = solver->solve(known.dual, Eigen::VectorXd::Zero(known.x.size()));
  EXPECT_EQ(solution.status, SolveStatus::solved);
  return velocity_of(known.primal, solution.x);
}

TEST(PrimalQp, FindsKnownSolutionsWithTheSignConventionOfTheDual) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 5; ++trial) {
    const KnownQp known = known_qp(random, 30, sharp_roles, 10);
    const PrimalQpSolution solution = solve_primal(known.primal);
    ASSERT_EQ(solution.status, SolveStatus::solved) << solution.residual;
    EXPECT_LE(solution.residual, accepted);
    EXPECT_LE(velocity_error(known.primal, solution.v, known.v), sharp);
    EXPECT_LE(multiplier_error(known, solution), 10 * sharp);
  }
}

TEST(PrimalQp, AgreesWithTheDual) {
  std::mt19937 random(13);
  for (int count = 1; count <= 4; ++count) {
    const KnownQp known = known_qp(random, 40, each_role(count), 10);
    const PrimalQpSolution solution = solve_primal(known.primal);
    ASSERT_EQ(solution.status, SolveStatus::solved) << solution.residual;
    EXPECT_LE(velocity_error(known.primal, solution.v, by_dual(known)), degenerate);
  }
}

TEST(PrimalQp, AgreesWithTheDualOnRedundantRows) {
  std::mt19937 random(14);
  const std::vector<Role> roles = {Role::bilateral, Role::active, Role::copy, Role::copy,
                                   Role::inactive,  Role::active, Role::copy};
  for (int trial = 0; trial < 5; ++trial) {
    const KnownQp known = known_qp(random, 12, roles, 10);
    const PrimalQpSolution solution = solve_primal(known.primal);
    ASSERT_EQ(solution.status, SolveStatus::solved) << solution.residual;
    EXPECT_LE(velocity_error(known.primal, solution.v, by_dual(known)), sharp);
  }
}

TEST(PrimalQp, SolvesWithoutRows) {
  std::mt19937 random(15);
  const KnownQp known = known_qp(random, 8, {});
  const PrimalQpSolution solution = solve_primal(known.primal);
  ASSERT_EQ(solution.status, SolveStatus::solved);
  EXPECT_LE(velocity_error(known.primal, solution.v, known.v), sharp);
}

TEST(PrimalQp, RefusesContradictoryRows) {
  std::mt19937 random(16);
  KnownQp known = known_qp(random, 5, {Role::active, Role::active});
  known.primal.C.row(1) = -known.primal.C.row(0);
  known.primal.d << 1, 1;
  EXPECT_EQ(solve_primal(known.primal).status, SolveStatus::infeasible);
}

TEST(PrimalQp, RejectsBadInput) {
  std::mt19937 random(17);
  KnownQp known = known_qp(random, 5, {Role::active});
  known.primal.cap.resize(0);
  EXPECT_THROW(solve_primal(known.primal), std::invalid_argument);
  known = known_qp(random, 5, {Role::active});
  known.primal.H(0, 0) = -1;
  EXPECT_THROW(dual_of(known.primal), std::invalid_argument);
}

TEST(DualOf, HasTheGradientThatItsHeaderStates) {
  // w = A x - b equals C v - d for any x, with v = H⁻¹ (g + C' x).
  std::mt19937 random(18);
  const KnownQp known = known_qp(random, 10, {Role::bilateral, Role::active, Role::inactive});
  const Eigen::VectorXd x = Eigen::Vector3d(0.3, -0.2, 0.7);
  const Eigen::VectorXd v = velocity_of(known.primal, x);
  Eigen::VectorXd w(3);
  w << known.primal.G * v - known.primal.e, known.primal.C * v - known.primal.d;
  // Rounding of sums of ten terms of size 1.
  EXPECT_LE((known.dual.A * x - known.dual.b - w).lpNorm<Eigen::Infinity>(), 1e-13);
}

}  // namespace hagfish::primal_qp_test
