#include "solvers/box_qp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random_qp.hpp"

namespace hagfish {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Sums of some 50 products of size 1 round to about 1e-15; H⁻¹ of condition 100 adds two digits.
constexpr double rounding = 1e-13;

/// Two uncoupled unilateral rows; solution (1, 0) with w = (0, 9). Scales s = (2, 3), β = 3.
BoxQp two_rows() {
  BoxQp qp;
  qp.A = Eigen::Vector2d(4, 9).asDiagonal();
  qp.b = Eigen::Vector2d(4, -9);
  qp.lower = Eigen::Vector2d::Zero();
  qp.upper = Eigen::Vector2d::Constant(infinity);
  return qp;
}

TEST(KktResiduals, AreZeroAtKnownSolutions) {
  std::mt19937 random(1);
  for (int count = 1; count <= 4; ++count) {
    const KnownQp known = known_qp(random, 40, each_role(count), 10);
    const KktResiduals r = kkt_residuals(known.dual, known.x);
    EXPECT_LE(r.primal, rounding);
    EXPECT_LE(r.complementarity, rounding);
  }
}

TEST(KktResiduals, HaveTheSizeOfTheError) {
  const double step = 1e-3;
  // Too large x₀: w₀ = 4 step pushes it down to its lower bound, 1 + step away.
  KktResiduals r = kkt_residuals(two_rows(), Eigen::Vector2d(1 + step, 0));
  EXPECT_EQ(r.primal, 0);
  EXPECT_NEAR(r.complementarity, 2 * step / 3 * (2 * (1 + step) / 3), rounding);
  // Too small x₀: w₀ < 0 and nothing above to rest on, the row is violated.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1 - step, 0));
  EXPECT_NEAR(r.primal, 2 * step / 3, rounding);
  EXPECT_EQ(r.complementarity, 0);
  // A force on a row that moves away.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1, step));
  EXPECT_NEAR(r.complementarity, step * (1 + step), rounding);
  // A pulling force.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1, -step));
  EXPECT_NEAR(r.primal, step, rounding);
}

TEST(KktResiduals, TellSoftAndFreeRowsFromHardOnes) {
  BoxQp qp = two_rows();
  qp.upper[0] = 0.5;
  // At its cap a soft row may fall short, w₀ = -2.
  EXPECT_EQ(kkt_residuals(qp, Eigen::Vector2d(0.5, 0)).worst(), 0);
  // Short of its cap it may not: ŵ₀ = 2.4 / 6 with room 0.1 * 2 / 3.
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(0.4, 0)).complementarity, 0.4 * 0.2 / 3, rounding);
  // Beyond it, never: 0.1 * 2 / 3 outside.
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(0.6, 0)).primal, 0.2 / 3, rounding);
  qp = two_rows();
  qp.lower[1] = -infinity;
  // A free row must not move away either: ŵ₁ = 9 / 9.
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(1, 0)).primal, 1, rounding);
  EXPECT_EQ(kkt_residuals(qp, Eigen::Vector2d(1, -1)).worst(), 0);
}

TEST(KktResiduals, DoNotDependOnUnits) {
  const BoxQp qp = two_rows();
  const Eigen::VectorXd x = Eigen::Vector2d(1.1, 0.2);
  const Eigen::VectorXd unit = Eigen::Vector2d(1e-4, 1e3);
  BoxQp other = qp;
  other.A = unit.asDiagonal() * qp.A * unit.asDiagonal();
  other.b = unit.cwiseProduct(qp.b);
  const KktResiduals r = kkt_residuals(qp, x);
  const KktResiduals s = kkt_residuals(other, x.cwiseQuotient(unit));
  EXPECT_NEAR(s.primal, r.primal, rounding);
  EXPECT_NEAR(s.complementarity, r.complementarity, rounding);
}

TEST(KktResiduals, UseTheVelocityGiven) {
  // w from elsewhere: the first row is violated by 0.6 / 2 / 3.
  const KktResiduals r = kkt_residuals(two_rows(), Eigen::Vector2d(1, 0), Eigen::Vector2d(-0.6, 9));
  EXPECT_NEAR(r.primal, 0.1, rounding);
}

TEST(KktResiduals, KeepRowsThatCannotMoveFromHidingOthers) {
  BoxQp qp = two_rows();
  qp.A(1, 1) = 0;
  EXPECT_EQ(kkt_residuals(qp, Eigen::Vector2d(1, 0)).worst(), 0);
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(0.9, 0)).primal, 0.1, rounding);
  qp.b[1] = 1e-6;
  EXPECT_GT(kkt_residuals(qp, Eigen::Vector2d(1, 0)).primal, 1e-6);
}

TEST(KktResiduals, AreInfiniteWhereSomethingIsNotFinite) {
  EXPECT_EQ(kkt_residuals(two_rows(), Eigen::Vector2d(nan, 0)).worst(), infinity);
  EXPECT_EQ(kkt_residuals(two_rows(), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, nan)).worst(),
            infinity);
}

TEST(CheckBoxQp, NamesWhatIsWrong) {
  EXPECT_NO_THROW(check_box_qp(two_rows()));
  BoxQp qp = two_rows();
  qp.b[0] = nan;
  EXPECT_THROW(check_box_qp(qp), std::invalid_argument);
  qp = two_rows();
  qp.lower[0] = 0.1;
  EXPECT_THROW(check_box_qp(qp), std::invalid_argument);
  qp = two_rows();
  qp.upper.resize(1);
  EXPECT_THROW(check_box_qp(qp), std::invalid_argument);
}

TEST(MakeBoxQpSolver, KnowsItsNames) {
  for (const std::string& name : box_qp_solver_names()) {
    EXPECT_NE(make_box_qp_solver(name), nullptr);
  }
  EXPECT_THROW(make_box_qp_solver("simplex"), std::invalid_argument);
}

TEST(SolveBilateral, MeetsIndependentRows) {
  std::mt19937 random(2);
  const KnownQp known = known_qp(random, 20, std::vector<Role>(12, Role::bilateral), 100);
  const BoxQpSolution solution = solve_bilateral(known.dual.A, known.dual.b);
  EXPECT_EQ(solution.status, SolveStatus::solved);
  EXPECT_LE((solution.x - known.x).cwiseQuotient(known.x).lpNorm<Eigen::Infinity>(), 1e3 * rounding)
      << "A has a condition of about 1e3";
}

TEST(SolveBilateral, SharesForceBetweenRedundantRows) {
  // The same row in two units, c and 10 c: equal shares after scaling, x₀ c + x₁ 10 c = c.
  Eigen::Matrix2d A;
  A << 1, 10, 10, 100;
  const BoxQpSolution solution = solve_bilateral(A, Eigen::Vector2d(1, 10));
  EXPECT_EQ(solution.status, SolveStatus::solved);
  EXPECT_NEAR(solution.x[0], 0.5, rounding);
  EXPECT_NEAR(solution.x[1], 0.05, rounding);
}

TEST(SolveBilateral, TakesRoundingForRedundancy) {
  // The last row is the sum of the others: A has rank 8 and, as an assembled one does,
  // a pivot of some 1e-14 left over.
  std::mt19937 random(19);
  const KnownQp known = known_qp(random, 20, std::vector<Role>(8, Role::bilateral));
  Eigen::MatrixXd combine = Eigen::MatrixXd::Ones(9, 8);
  combine.topRows(8).setIdentity();
  Eigen::MatrixXd A = combine * known.dual.A * combine.transpose();
  A(8, 8) *= 1 + 1e-14;
  const BoxQpSolution solution = solve_bilateral(A, combine * known.dual.b);
  EXPECT_EQ(solution.status, SolveStatus::solved);
  // The least solution has no part along what cannot be told: +1 on each row, -1 on their sum.
  const Eigen::VectorXd scale = row_scale(A);
  Eigen::VectorXd idle = scale;
  idle[8] *= -1;
  EXPECT_LE(std::abs(solution.x.cwiseProduct(scale).dot(idle)), 1e3 * rounding * idle.norm());
}

TEST(SolveBilateral, RefusesContradictoryRows) {
  Eigen::Matrix2d A;
  A << 1, 10, 10, 100;
  EXPECT_EQ(solve_bilateral(A, Eigen::Vector2d(1, 10.001)).status, SolveStatus::infeasible);
  EXPECT_EQ(solve_bilateral(Eigen::Matrix2d::Zero(), Eigen::Vector2d(0, 1)).status,
            SolveStatus::infeasible);
}

TEST(SolveBilateral, TakesNothing) {
  EXPECT_EQ(solve_bilateral(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)).status, SolveStatus::solved);
  const BoxQpSolution rest = solve_bilateral(Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero());
  EXPECT_EQ(rest.status, SolveStatus::solved);
  EXPECT_TRUE(rest.x.isZero(0));
}

}  // namespace
}  // namespace hagfish
