#include "solvers/free_rows.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_qp.hpp"

namespace hagfish::free_rows_test {

constexpr double rounding = 1e-13;  // of sums of a few terms of size 1 to 10

TEST(BoundedPart, KeepsTheGradientOfTheRowsItKeeps) {
  std::mt19937 random(20);
  const KnownQp known = known_qp(
      random, 20, {Role::bilateral, Role::bilateral, Role::active, Role::inactive, Role::at_cap});
  const BoundedPart part(known.dual);
  ASSERT_TRUE(part.consistent());
  ASSERT_EQ(part.reduced().b.size(), 3);
  const Eigen::VectorXd y = Eigen::Vector3d(0.3, 0.1, 0.7);
  const Eigen::VectorXd x = part.expand(y);
  EXPECT_EQ(part.restrict_to_reduced(x), y);
  const Eigen::VectorXd w = known.dual.A * x - known.dual.b;
  EXPECT_LE(w.head(2).lpNorm<Eigen::Infinity>(), rounding) << "free rows are met";
  EXPECT_LE((part.reduced().A * y - part.reduced().b - w.tail(3)).lpNorm<Eigen::Infinity>(),
            rounding);
}

TEST(SemidefiniteFactor, SharesForceBetweenRedundantRows) {
  // The same row in two units, c and 10 c: equal shares after scaling, x₀ c + x₁ 10 c = c.
  Eigen::Matrix2d A;
  A << 1, 10, 10, 100;
  const SemidefiniteFactor factor(A);
  const Eigen::Vector2d b(1, 10);
  const Eigen::VectorXd x = factor.solve(b);
  EXPECT_TRUE(factor.meets(x, b, Eigen::VectorXd::Zero(x.size())));
  EXPECT_NEAR(x[0], 0.5, rounding);
  EXPECT_NEAR(x[1], 0.05, rounding);
}

TEST(SemidefiniteFactor, TakesRoundingForRedundancy) {
  // The last row is the sum of the others: A has rank 8 and, as an assembled one does,
  // a pivot of some 1e-14 left over.
  std::mt19937 random(19);
  const KnownQp known = known_qp(random, 20, std::vector<Role>(8, Role::bilateral));
  Eigen::MatrixXd combine = Eigen::MatrixXd::Ones(9, 8);
  combine.topRows(8).setIdentity();
  Eigen::MatrixXd A = combine * known.dual.A * combine.transpose();
  A(8, 8) *= 1 + 1e-14;
  const SemidefiniteFactor factor(A);
  const Eigen::VectorXd b = combine * known.dual.b;
  const Eigen::VectorXd x = factor.solve(b);
  EXPECT_TRUE(factor.meets(x, b, Eigen::VectorXd::Zero(x.size())));
  // The least solution has no part along what cannot be told: +1 on each row, -1 on their sum.
  const Eigen::VectorXd scale = row_scale(A);
  Eigen::VectorXd idle = scale;
  idle[8] *= -1;
  EXPECT_LE(std::abs(x.cwiseProduct(scale).dot(idle)), 1e3 * rounding * idle.norm());
}

}  // namespace hagfish::free_rows_test
