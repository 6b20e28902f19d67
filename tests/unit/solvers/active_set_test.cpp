// What is the active set method's own; every_solver_test.cpp has what it shares with Ipopt.
#include "solvers/active_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/support/random_qp.hpp"

namespace hagfish::active_set_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Rounding of A x - b: 60 products of size 1 and multipliers up to 10; A of condition up to 1e3.
constexpr double settled = 1e-12;

BoxQpSolution solve_cold(const BoxQp& qp) {
  return ActiveSetBoxQp().solve(qp, Eigen::VectorXd::Zero(qp.b.size()));
}

/// Row k of the result is row order[k] of `qp`.
BoxQp permuted(const BoxQp& qp, const std::vector<Eigen::Index>& order) {
  return {qp.A(order, order), qp.b(order), qp.lower(order), qp.upper(order)};
}

std::vector<Eigen::Index> shuffled(std::mt19937& random, Eigen::Index size) {
  std::vector<Eigen::Index> order(size);
  std::iota(order.begin(), order.end(), 0);
  for (Eigen::Index i = size - 1; i > 0; --i) {
    std::swap(order[i], order[random() % (i + 1)]);
  }
  return order;
}

/// A small problem of rank 3 on which blocks of rows change sides for ever, and its solution.
BoxQp cycling_qp() {
  Eigen::Matrix3d J;
  J << -2, 2, 0, -1, 2, 0, 0, -2, -1;
  return qp_of_rows(J, Eigen::Vector3d(0, -1, 2));
}
Eigen::VectorXd cycling_x() { return Eigen::Vector3d(1.0 / 3, 0, 2.0 / 3); }

TEST(ActiveSetPivoting, BlocksGiveUpWhereTheyCycleAndSingleChangesEnd) {
  const BoxQp qp = cycling_qp();
  ActiveSetPivoting pivoting;
  pivoting.start(qp);
  EXPECT_FALSE(pivoting.change_blocks());
  EXPECT_EQ(pivoting.change_singly(), ActiveSetPivoting::Ending::settled);
  EXPECT_LE((pivoting.x() - cycling_x()).lpNorm<Eigen::Infinity>(), settled);
  EXPECT_LE((solve_cold(qp).x - cycling_x()).lpNorm<Eigen::Infinity>(), settled);
}

TEST(ActiveSetPivoting, SingleChangesEndOnRowsThatDependAndMeetInOnePoint) {
  // Rows of -1, 0 and 1 in up to 4 velocities, all through one point or short of it by 1 or 2:
  // copies, sums, corners of many rows, caps that are just met.
  std::mt19937 random(32);
  const auto draw = [&random](int low, int high) {
    return low + static_cast<int>(random() % (high - low + 1));
  };
  for (int trial = 0; trial < 500; ++trial) {
    const int n = draw(1, 4);
    const int m = draw(1, 30);
    const Eigen::MatrixXd J = Eigen::MatrixXd::NullaryExpr(m, n, [&] { return draw(-1, 1); });
    const Eigen::VectorXd v = Eigen::VectorXd::NullaryExpr(n, [&] { return draw(-2, 2); });
    BoxQp qp = qp_of_rows(J, J * v);
    for (int i = 0; i < m; ++i) {
      switch (draw(0, 4)) {
        case 0:
          qp.lower[i] = -infinity;
          break;
        case 1:
          qp.upper[i] = draw(0, 2);
          break;
        default:
          qp.b[i] -= draw(0, 2);
      }
    }
    ActiveSetPivoting pivoting;
    pivoting.start(qp);
    ASSERT_EQ(pivoting.change_singly(), ActiveSetPivoting::Ending::settled) << trial;
    const Eigen::VectorXd x = pivoting.x();
    EXPECT_LE(kkt_residuals(qp, x).worst(), settled) << trial;
    const BoxQpSolution solution = solve_cold(qp);
    ASSERT_EQ(solution.status, SolveStatus::solved) << trial << solution.message;
    EXPECT_LE((J.transpose() * (solution.x - x)).lpNorm<Eigen::Infinity>(), settled)
        << "velocity by blocks, trial " << trial;
  }
}

TEST(ActiveSetBoxQp, ForgetsHugeMultipliersOnItsWay) {
  // Two rows 1e-5 rad apart; met both at once, as the start has it, they take multipliers of 1e10.
  Eigen::MatrixXd J(2, 2);
  J << 1, 0, 1, 1e-5;
  const BoxQp qp = qp_of_rows(J, Eigen::VectorXd::Unit(2, 1));
  const BoxQpSolution solution = ActiveSetBoxQp().solve(qp, Eigen::VectorXd::Ones(2));
  ASSERT_EQ(solution.status, SolveStatus::solved) << solution.message;
  EXPECT_EQ(solution.x[0], 0);
  EXPECT_LE(std::abs(solution.x[1] - 1 / (1 + 1e-10)), settled);
}

/// `J` v >= b among eight rows of the same velocities that are fine; where the rows of J went.
struct Hidden {
  BoxQp qp;
  std::vector<Eigen::Index> place;
};

Hidden hide(std::mt19937& random, const Eigen::MatrixXd& J, const Eigen::VectorXd& b) {
  Eigen::MatrixXd all(J.rows() + 8, J.cols());
  all.topRows(J.rows()) = J;
  all.bottomRows(8) = Eigen::MatrixXd::NullaryExpr(
      8, J.cols(), [&] { return static_cast<double>(random() % 200) / 100 - 1; });
  Eigen::VectorXd rhs(all.rows());
  rhs << b, all.bottomRows(8) * Eigen::VectorXd::Ones(J.cols()) - Eigen::VectorXd::Ones(8);
  const std::vector<Eigen::Index> order = shuffled(random, all.rows());
  Hidden hidden{permuted(qp_of_rows(all, rhs), order), {}};
  for (Eigen::Index row = 0; row < J.rows(); ++row) {
    hidden.place.push_back(std::find(order.begin(), order.end(), row) - order.begin());
  }
  return hidden;
}

std::string names(std::vector<Eigen::Index> rows) {
  std::sort(rows.begin(), rows.end());
  std::string text;
  for (const Eigen::Index row : rows) {
    text += (text.empty() ? "" : ", ") + std::to_string(row);
  }
  return text;
}

TEST(ActiveSetBoxQp, NamesTheRowsThatContradictEachOther) {
  std::mt19937 random(39);
  Eigen::MatrixXd pair = Eigen::MatrixXd::Zero(2, 10);
  pair.col(9) << 1, -3;
  // Each two of these can be met, the three cannot: their sum is 0 v >= margin.
  Eigen::MatrixXd triple = Eigen::MatrixXd::Zero(3, 10);
  triple.rightCols(2) << 1, 0, 1, 1, -2, -1;
  for (const double margin : {1.0, 1e-3, 1e-6}) {
    for (int trial = 0; trial < 5; ++trial) {
      const Hidden two = hide(random, pair, Eigen::Vector2d(2, -6 + margin));
      const BoxQpSolution of_two = solve_cold(two.qp);
      EXPECT_EQ(of_two.status, SolveStatus::infeasible);
      EXPECT_EQ(of_two.message, "rows contradict each other: " + names(two.place));
      const Hidden three = hide(random, triple, Eigen::Vector3d(1, 2, -3 + margin));
      const BoxQpSolution of_three = solve_cold(three.qp);
      EXPECT_EQ(of_three.status, SolveStatus::infeasible);
      EXPECT_EQ(of_three.message, "rows contradict each other: " + names(three.place));
      EXPECT_TRUE(of_three.x.allFinite() && (of_three.x.array() >= 0).all());
    }
  }
}

TEST(ActiveSetBoxQp, TellsDependentRowsWhereTheOthersAreNearlyParallel) {
  // Rows 0 and 1 leave row 2 a pivot of rounding times 1e8, the square of its shares in them.
  Eigen::MatrixXd J(3, 2);
  J << 1, 0, -1, -1e-4, 0, 1;
  Eigen::VectorXd b(3);
  b << 1, -1, 1;
  const BoxQpSolution solution = ActiveSetBoxQp().solve(qp_of_rows(J, b), Eigen::VectorXd::Ones(3));
  EXPECT_EQ(solution.status, SolveStatus::infeasible);
  EXPECT_EQ(solution.message, "rows contradict each other: 0, 1, 2");
}

TEST(ActiveSetBoxQp, NamesBilateralRowsAndRowsThatCannotMove) {
  BoxQp qp = qp_of_rows(Eigen::Vector3d(1, 0, 2), Eigen::Vector3d(1, -1, 2.1));
  qp.lower.setConstant(-infinity);
  qp.lower[1] = 0;
  EXPECT_EQ(solve_cold(qp).message, "rows contradict each other: 0, 2");
  qp.b << 1, 1, 2;
  EXPECT_EQ(solve_cold(qp).message, "row cannot be met: 1");
}

}  // namespace hagfish::active_set_test
