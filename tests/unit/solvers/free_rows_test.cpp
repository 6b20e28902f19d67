#include "solvers/free_rows.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_qp.hpp"

namespace hagfish {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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
  // Rounding of sums of a few terms of size 1 to 10.
  EXPECT_LE(w.head(2).lpNorm<Eigen::Infinity>(), 1e-13) << "free rows are met";
  EXPECT_LE((part.reduced().A * y - part.reduced().b - w.tail(3)).lpNorm<Eigen::Infinity>(), 1e-13);
}

TEST(BoundedPart, LeavesOutRowsWithoutRoomOrMotion) {
  BoxQp qp;
  qp.A = Eigen::Vector3d(1, 2, 0).asDiagonal();
  qp.b = Eigen::Vector3d(1, 1, -1);
  qp.lower = Eigen::Vector3d::Zero();
  qp.upper = Eigen::Vector3d(infinity, 0, infinity);
  const BoundedPart part(qp);
  EXPECT_TRUE(part.consistent());
  ASSERT_EQ(part.reduced().b.size(), 1);
  EXPECT_EQ(part.expand(Eigen::VectorXd::Constant(1, 5)),
            Eigen::VectorXd(Eigen::Vector3d(5, 0, 0)));
}

}  // namespace
}  // namespace hagfish
