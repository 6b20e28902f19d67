#include "solvers/qp_reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/random_qp.hpp"

namespace hagfish::qp_reference_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// known_qp makes its problems in double: the rounding of g, d and A, a condition of H of 100 and
/// of A of 100 to 1e4.
constexpr double known_to = 1e-11;

TEST(QpReference, IsSharperThanDouble) {
  // x = 1/3: what doubles miss of it must show, to long double's own rounding.
  BoxQp qp;
  qp.A = (Eigen::Matrix2d() << 2, 1, 1, 2).finished();
  qp.b = Eigen::Vector2d::Ones();
  qp.lower = Eigen::Vector2d::Zero();
  qp.upper = Eigen::Vector2d::Constant(infinity);
  QpReference reference(qp);
  ASSERT_TRUE(reference.solve(Eigen::Vector2d::Zero()));
  const auto missed = static_cast<double>(1.0L / 3 - static_cast<long double>(1.0 / 3));
  const VelocityError error = reference.error(Eigen::Vector2d::Constant(1.0 / 3));
  EXPECT_NEAR(error.norm, std::sqrt(6) * missed, 1e-18);
  EXPECT_NEAR(error.relative, std::sqrt(6) * missed / std::sqrt(2.0 / 3), 1e-18)
      << "over sqrt(x' A x), which is more than |b| / s";
  EXPECT_EQ(error.largest, 0) << "a box QP does not know v";
}

TEST(QpReference, FindsKnownSolutionsFromAnyGuess) {
  std::mt19937 random(31);
  for (int count = 1; count <= 8; ++count) {
    const KnownQp known = known_qp(random, 60, each_role(count), 10);
    QpReference of_dual(known.dual), of_primal(known.primal);
    for (const double size : {0.0, 1.0, -1.0, 1e6}) {
      const Eigen::VectorXd guess = size * Eigen::VectorXd::Ones(known.x.size());
      ASSERT_TRUE(of_dual.solve(guess)) << count << " " << size;
      ASSERT_TRUE(of_primal.solve(guess)) << count << " " << size;
      EXPECT_LE(of_dual.error(known.x).relative, known_to);
      EXPECT_LE(of_primal.error(known.x).relative, known_to);
      EXPECT_LE(of_primal.error(known.x).largest_relative, known_to);
    }
  }
}

TEST(QpReference, MeasuresVelocities) {
  std::mt19937 random(32);
  const KnownQp known = known_qp(random, 30, each_role(3), 10);
  QpReference reference(known.primal);
  ASSERT_TRUE(reference.solve(known.x));
  const Eigen::VectorXd x = known.x + 0.1 * known.x.cwiseAbs() + 0.01 * known.x.reverse();
  const Eigen::VectorXd off = velocity_of(known.primal, x) - known.v;
  const Eigen::VectorXd change =
      known.v - velocity_of(known.primal, Eigen::VectorXd::Zero(x.size()));
  const double norm = std::sqrt(off.dot(known.primal.H * off));
  const VelocityError error = reference.error(x);
  EXPECT_NEAR(error.norm, norm, known_to * norm);
  const double relative = norm / std::max(std::sqrt(change.dot(known.primal.H * change)),
                                          rhs_scale(known.dual, row_scale(known.dual.A)));
  EXPECT_NEAR(error.relative, relative, known_to * relative);
  const double largest = off.lpNorm<Eigen::Infinity>();
  EXPECT_NEAR(error.largest, largest, known_to * largest);
  const double velocity =
      std::max(known.v.lpNorm<Eigen::Infinity>(), (known.v - change).lpNorm<Eigen::Infinity>());
  EXPECT_NEAR(error.largest_relative, largest / velocity, known_to * largest);
}

TEST(QpReference, KnowsTheVelocityWhereMultipliersAreNotUnique) {
  std::mt19937 random(33);
  const std::vector<Role> roles = {Role::bilateral, Role::active, Role::copy, Role::copy,
                                   Role::inactive,  Role::active, Role::copy, Role::at_cap};
  for (int trial = 0; trial < 10; ++trial) {
    const KnownQp known = known_qp(random, 12, roles, 10);
    QpReference reference(known.primal);
    QpReference of_dual(known.dual);
    // As a back end finds it: another share of the copies' force.
    const auto solver = make_box_qp_solver("active-set");
    const BoxQpSolution found = solver->solve(known.dual, Eigen::VectorXd::Zero(known.x.size()));
    ASSERT_EQ(found.status, SolveStatus::solved);
    ASSERT_TRUE(reference.solve(found.x)) << trial;
    EXPECT_LE(reference.error(known.x).relative, known_to);
    EXPECT_LE(reference.error(found.x).largest_relative, known_to);
    ASSERT_TRUE(of_dual.solve(found.x)) << trial;
    EXPECT_LE(of_dual.error(known.x).relative, known_to);
  }
}

TEST(QpReference, TakesDependentRowsThatContradictEachOtherByRounding) {
  // v >= 1, 2 v >= 2 + 1e-14: both active at first, the first is met by the second alone.
  const BoxQp qp = qp_of_rows(Eigen::Vector2d(1, 2), Eigen::Vector2d(1, 2 + 1e-14));
  QpReference reference(qp);
  ASSERT_TRUE(reference.solve(Eigen::Vector2d(0.2, 0.4)));
  EXPECT_NEAR(reference.error(Eigen::Vector2d(1 + 5e-15, 0)).norm, 0, 1e-16)
      << "the same velocity by the other row, to the rounding of 1 + 5e-15";
}

TEST(QpReference, HasNoneWhereRowsContradictEachOther) {
  const BoxQp qp = qp_of_rows(Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1));
  EXPECT_FALSE(QpReference(qp).solve(Eigen::Vector2d::Zero()));
  EXPECT_FALSE(QpReference(qp).solve(Eigen::Vector2d(1e6, 1e6)));
}

TEST(QpReference, TakesWhatHasNothingToSolve) {
  std::mt19937 random(34);
  const KnownQp free = known_qp(random, 4, {});
  QpReference without_rows(free.primal);
  ASSERT_TRUE(without_rows.solve(Eigen::VectorXd(0)));
  EXPECT_EQ(without_rows.error(Eigen::VectorXd(0)).norm, 0);
  // Nothing pushes: errors are relative to 1.
  BoxQp qp = unilateral_qp(4 * Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, -4));
  QpReference at_rest(qp);
  ASSERT_TRUE(at_rest.solve(Eigen::VectorXd::Ones(1)));
  EXPECT_EQ(at_rest.error(Eigen::VectorXd::Zero(1)).norm, 0);
  EXPECT_EQ(at_rest.error(Eigen::VectorXd::Ones(1)).relative, 2);
  qp.upper[0] = 0;  // no room
  qp.b[0] = 4;
  QpReference stuck(qp);
  ASSERT_TRUE(stuck.solve(Eigen::VectorXd::Zero(1)));
  EXPECT_EQ(stuck.error(Eigen::VectorXd::Zero(1)).norm, 0);
}

TEST(QpReference, RejectsBadInput) {
  BoxQp qp = unilateral_qp(Eigen::Matrix2d::Identity(), Eigen::Vector2d::Ones());
  qp.lower[0] = 1;
  EXPECT_THROW(QpReference{qp}, std::invalid_argument);
}

}  // namespace hagfish::qp_reference_test
