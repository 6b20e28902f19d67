#include "solvers/fixed_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>

namespace hagfish::fixed_point_test {

/// x after `passes` of x <- g(x) from 0, mixed.
Eigen::VectorXd after(int passes, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& g,
                      AndersonMixing& mixing) {
  mixing.restart();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3), next;
  for (int k = 0; k < passes; ++k) {
    mixing.mix(x, g(x), next);
    x = next;
  }
  return x;
}

const Eigen::Matrix3d slope =
    (Eigen::Matrix3d() << -1.5, 0.3, 0, 0.1, 0.8, 0.2, 0, -0.4, -1.2).finished();
const Eigen::Vector3d shift(1, -2, 0.5);

// As many changes as unknowns tell all of a linear map: plain passes would run away.
TEST(AndersonMixing, SolvesALinearMapInOnePassMoreThanItHasUnknowns) {
  const auto g = [](const Eigen::VectorXd& x) -> Eigen::VectorXd { return slope * x + shift; };
  const Eigen::Vector3d fixed = (Eigen::Matrix3d::Identity() - slope).inverse() * shift;
  AndersonMixing mixing;
  // To the share of the trace on the diagonal, times the condition of the changes.
  EXPECT_LT((after(4, g, mixing) - fixed).norm(), 1e-6 * fixed.norm());
  EXPECT_GT((after(3, g, mixing) - fixed).norm(), 1e-3 * fixed.norm());
}

TEST(AndersonMixing, BeginsAnewWithAPlainPass) {
  const auto g = [](const Eigen::VectorXd& x) -> Eigen::VectorXd { return slope * x + shift; };
  AndersonMixing mixing;
  after(4, g, mixing);
  EXPECT_EQ(after(1, g, mixing), Eigen::VectorXd(shift));
  AndersonMixing fresh;
  EXPECT_EQ(after(3, g, mixing), after(3, g, fresh));
}

// Where nothing changes any more there is nothing to mix, and nothing to divide by.
TEST(AndersonMixing, StaysAtAFixedPoint) {
  const auto g = [](const Eigen::VectorXd& /*x*/) -> Eigen::VectorXd { return shift; };
  AndersonMixing mixing;
  EXPECT_EQ(after(5, g, mixing), Eigen::VectorXd(shift));
}

}  // namespace hagfish::fixed_point_test
