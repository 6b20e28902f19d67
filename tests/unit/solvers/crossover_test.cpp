#include "solvers/crossover.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hagfish::crossover_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double settled = 1e-12;  // rounding

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
