// The factor of an active set against dense algebra, as rows come and go.
#include "solvers/active_set_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "tests/support/random_chain.hpp"

namespace hagfish::active_set_factor_test {

using Indices = std::vector<Eigen::Index>;

/// A = J J' for rows J (m x n), brought to unit diagonal for the factor.
class Problem {
 public:
  explicit Problem(const Eigen::MatrixXd& J)
      : A(J * J.transpose()), scale_(A.diagonal().cwiseSqrt().cwiseInverse()) {
    factor.reset(A, inverse_scale_);
  }
  Problem(const Problem&) = delete;

  /// The largest error of solve() over the largest entry, in rows of unit diagonal.
  double error(const Eigen::VectorXd& c) {
    const Indices& rows = factor.rows();
    const Eigen::MatrixXd block = (scale_.asDiagonal() * A * scale_.asDiagonal())(rows, rows);
    const Eigen::VectorXd expected = block.ldlt().solve(scale_.cwiseProduct(c)(rows));
    return relative_error(factor.solve(c).cwiseQuotient(scale_(rows)), expected);
  }

  const Eigen::MatrixXd A;
  ActiveSetFactor factor;

 private:
  Eigen::VectorXd scale_;
  Eigen::Map<Eigen::VectorXd> inverse_scale_{scale_.data(), scale_.size()};
};

Eigen::MatrixXd random_rows(Random& random, Eigen::Index m, Eigen::Index n) {
  return random_entries(random, m * n).reshaped(m, n);
}

/// Of blocks whose condition is below 1e5: rounding of 1e-16 times that.
constexpr double rounding = 1e-11;

TEST(ActiveSetFactor, SolvesTheBlockOfItsRowsInTheirOrder) {
  Random random(1);
  Problem p(random_rows(random, 30, 40));
  const Eigen::VectorXd c = random_entries(random, 30);
  EXPECT_EQ(p.factor.solve(c).size(), 0);
  // Across panels of eight, from one row to many at once.
  EXPECT_TRUE(p.factor.append(Indices{7}));
  EXPECT_LE(p.error(c), rounding);
  EXPECT_TRUE(p.factor.append(Indices{29, 3, 11, 0, 20, 5}));
  EXPECT_LE(p.error(c), rounding);
  EXPECT_TRUE(p.factor.append(Indices{1, 2}));
  EXPECT_EQ(p.factor.rows(), (Indices{7, 29, 3, 11, 0, 20, 5, 1, 2}));
  EXPECT_LE(p.error(c), rounding);
  for (Eigen::Index row = 0; row < 30; ++row) {
    EXPECT_EQ(p.factor.contains(row), std::ranges::count(p.factor.rows(), row) == 1) << row;
  }
}

TEST(ActiveSetFactor, StaysExactThroughAThousandChanges) {
  Random random(3);
  Problem p(random_rows(random, 40, 60));
  const Eigen::VectorXd c = random_entries(random, 40);
  for (int k = 0; k < 1000; ++k) {
    Indices in, out;
    for (Eigen::Index row = 0; row < 40; ++row) {
      if (uniform(random, 0, 1) < 0.1) (p.factor.contains(row) ? out : in).push_back(row);
    }
    ASSERT_TRUE(p.factor.change(out, in));
  }
  EXPECT_LE(p.error(c), rounding);
}

TEST(ActiveSetFactor, RefusesRowsThatDependOnThoseBefore) {
  Random random(4);
  Eigen::MatrixXd J = random_rows(random, 12, 20);
  J.row(5) = 3 * J.row(1) - J.row(2);
  J.row(8) = -1e6 * J.row(0);  // the same row in another unit
  Problem p(J);
  const Eigen::VectorXd c = random_entries(random, 12);
  // Refused in the middle of a panel; what stands behind it comes in.
  EXPECT_FALSE(p.factor.append(Indices{0, 1, 8, 2, 5, 3, 4}));
  EXPECT_EQ(p.factor.rows(), (Indices{0, 1, 2, 3, 4}));
  EXPECT_FALSE(p.factor.contains(5));
  EXPECT_FALSE(p.factor.contains(8));
  EXPECT_LE(p.error(c), rounding);
  // Once a row on which it depends is gone, it may come in.
  EXPECT_TRUE(p.factor.change(Indices{1, 0}, Indices{5, 8}));
  EXPECT_FALSE(p.factor.append(Indices{1}));
  EXPECT_EQ(p.factor.rows(), (Indices{2, 3, 4, 5, 8}));
  EXPECT_LE(p.error(c), rounding);
}

TEST(ActiveSetFactor, TakesRowsThatAlmostDepend) {
  // 1e-4 apart: a pivot of 1e-8, far above 1e-12, and a condition of 1e8.
  Random random(5);
  Eigen::MatrixXd J = random_rows(random, 6, 20);
  J.row(3) = J.row(1) + 1e-4 * J.row(5);
  Problem p(J);
  EXPECT_TRUE(p.factor.append(Indices{0, 1, 2, 3}));
  EXPECT_LE(p.error(random_entries(random, 6)), 1e-16 * 1e8 * 100);
}

}  // namespace hagfish::active_set_factor_test
