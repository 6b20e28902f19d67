#include "solvers/crossover.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_qp.hpp"

namespace hagfish::crossover_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Rounding of A x - b for some 50 rows, and a condition of A up to 1e3 for x.
constexpr double settled = 1e-12;

/// A problem whose rows come in units in which A has unit diagonal, and its solution.
struct UnitQp {
  BoxQp qp;
  Eigen::VectorXd x;
};

UnitQp unit_qp(std::mt19937& random, int count) {
  std::vector<Role> roles = each_role(count);
  roles.erase(roles.begin(), roles.begin() + count);  // bilateral rows are eliminated before
  const KnownQp known = known_qp(random, 60, roles);
  const Eigen::VectorXd s = row_scale(known.dual.A);
  const Eigen::VectorXd inverse = s.cwiseInverse();
  UnitQp unit;
  unit.qp = {inverse.asDiagonal() * known.dual.A * inverse.asDiagonal(),
             inverse.cwiseProduct(known.dual.b), known.dual.lower,
             s.cwiseProduct(known.dual.upper)};
  unit.x = s.cwiseProduct(known.x);
  return unit;
}

TEST(NaturalResidual, IsTheErrorOfOneRow) {
  BoxQp qp;
  qp.A = Eigen::MatrixXd::Identity(1, 1);
  qp.b = Eigen::VectorXd::Constant(1, 0.5);
  qp.lower = Eigen::VectorXd::Zero(1);
  qp.upper = Eigen::VectorXd::Constant(1, infinity);
  EXPECT_EQ(natural_residual(qp, Eigen::VectorXd::Constant(1, 0.5)), 0);
  EXPECT_EQ(natural_residual(qp, Eigen::VectorXd::Constant(1, 0.75)), 0.25);
  qp.b[0] = -1;
  EXPECT_EQ(natural_residual(qp, Eigen::VectorXd::Constant(1, 0.25)), 0.25);
}

TEST(Crossover, TakesAnInteriorPointToItsVertex) {
  std::mt19937 random(21);
  for (int count = 1; count <= 8; ++count) {
    const UnitQp unit = unit_qp(random, count);
    // As an interior point stops: off by 1e-5 where rows are degenerate, and inside the bounds.
    const Eigen::VectorXd near =
        (unit.x.array() + 1e-5).matrix().cwiseMin(unit.qp.upper * (1 - 1e-5));
    const Eigen::VectorXd x = crossover(unit.qp, near);
    EXPECT_LE((x - unit.x).lpNorm<Eigen::Infinity>(), settled);
    EXPECT_LE(natural_residual(unit.qp, x), settled);
  }
}

TEST(Crossover, CorrectsWrongSides) {
  // From nothing known: a third of the rows start on the wrong side.
  std::mt19937 random(22);
  for (int count = 1; count <= 4; ++count) {
    const UnitQp unit = unit_qp(random, count);
    const Eigen::VectorXd x = crossover(unit.qp, Eigen::VectorXd::Zero(unit.x.size()));
    EXPECT_LE((x - unit.x).lpNorm<Eigen::Infinity>(), settled);
  }
}

TEST(Crossover, LeavesRowsThatShareAForceTheirShares) {
  BoxQp qp;
  qp.A = Eigen::Matrix2d::Ones();
  qp.b = Eigen::Vector2d::Ones();
  qp.lower = Eigen::Vector2d::Zero();
  qp.upper = Eigen::Vector2d::Constant(infinity);
  const Eigen::VectorXd x = crossover(qp, Eigen::Vector2d(0.4 + 1e-6, 0.6));
  EXPECT_LE((x - Eigen::Vector2d(0.4, 0.6)).lpNorm<Eigen::Infinity>(), settled);
}

TEST(Crossover, ReturnsItsArgumentWhereNothingIsSettled) {
  // Two rows that contradict each other: no vertex solves them.
  BoxQp qp;
  qp.A = Eigen::Matrix2d::Identity();
  qp.A(0, 1) = qp.A(1, 0) = -1;
  qp.b = Eigen::Vector2d(1, 1);
  qp.lower = Eigen::Vector2d::Zero();
  qp.upper = Eigen::Vector2d::Constant(infinity);
  const Eigen::VectorXd x = Eigen::Vector2d(2, 3);
  EXPECT_EQ(crossover(qp, x), x);
}

}  // namespace hagfish::crossover_test
