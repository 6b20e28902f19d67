#include "solvers/box_qp.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_qp.hpp"

namespace hagfish::box_qp_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Sums of some 50 products of size 1 round to about 1e-15; H⁻¹ of condition 100 adds two digits.
constexpr double rounding = 1e-13;

/// Two uncoupled unilateral rows; solution (1, 0) with w = (0, 9). Scales s = (2, 3); only the
/// first pushes at x = 0, so β = 2.
BoxQp two_rows() {
  BoxQp qp;
  qp.A = Eigen::Vector2d(4, 9).asDiagonal();
  qp.b = Eigen::Vector2d(4, -9);
  qp.lower = Eigen::Vector2d::Zero();
  qp.upper = Eigen::Vector2d::Constant(infinity);
  return qp;
}

KktResiduals with_gradient(const Eigen::Vector2d& x, const Eigen::Vector2d& w,
                           double least_beta = 0) {
  return kkt_residuals(two_rows(), x, w, row_scale(two_rows().A), least_beta);
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
  EXPECT_NEAR(r.complementarity, step * (1 + step), rounding);
  // Too small x₀: w₀ < 0 and nothing above to rest on, the row is violated.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1 - step, 0));
  EXPECT_NEAR(r.primal, step, rounding);
  EXPECT_EQ(r.complementarity, 0);
  // A force on a row that moves away.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1, step));
  EXPECT_NEAR(r.complementarity, 1.5 * step * 1.5 * (1 + step), rounding);
  // A pulling force.
  r = kkt_residuals(two_rows(), Eigen::Vector2d(1, -step));
  EXPECT_NEAR(r.primal, 1.5 * step, rounding);
}

TEST(KktResiduals, TellSoftAndFreeRowsFromHardOnes) {
  BoxQp qp = two_rows();
  qp.upper[0] = 0.5;
  // At its cap a soft row may fall short, w₀ = -2.
  EXPECT_EQ(kkt_residuals(qp, Eigen::Vector2d(0.5, 0)).worst(), 0);
  // Short of its cap it may not: ŵ₀ = 2.4 / 4 with room 0.1 * 2 / 2.
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(0.4, 0)).complementarity, 0.6 * 0.1, rounding);
  // Beyond it, never: 0.1 * 2 / 2 outside.
  EXPECT_NEAR(kkt_residuals(qp, Eigen::Vector2d(0.6, 0)).primal, 0.1, rounding);
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
  // w from elsewhere: the first row is violated by 0.6 / 2 / 2.
  const KktResiduals r = with_gradient(Eigen::Vector2d(1, 0), Eigen::Vector2d(-0.6, 9));
  EXPECT_NEAR(r.primal, 0.15, rounding);
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
  EXPECT_EQ(with_gradient(Eigen::Vector2d(1, 0), Eigen::Vector2d(0, nan)).worst(), infinity);
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

TEST(KktResiduals, ScaleOfALargerProblemMakesThemSmaller) {
  const Eigen::Vector2d x(0.5, 0);
  const Eigen::Vector2d w(-0.6, 3);
  const KktResiduals own = with_gradient(x, w);
  const double beta = rhs_scale(two_rows(), row_scale(two_rows().A));
  const KktResiduals part = with_gradient(x, w, 10 * beta);
  EXPECT_NEAR(part.primal, own.primal / 10, rounding);
  EXPECT_NEAR(part.complementarity, own.complementarity / 100, rounding);
  EXPECT_EQ(with_gradient(x, w, 0.1 * beta).primal, own.primal);
}

TEST(MakeBoxQpSolver, KnowsItsNames) {
  for (const std::string& name : box_qp_solver_names()) {
    EXPECT_NE(make_box_qp_solver(name), nullptr);
  }
  EXPECT_THROW(make_box_qp_solver("simplex"), std::invalid_argument);
}

}  // namespace hagfish::box_qp_test
