// What the pull comes to, from means that are made by hand.
#include "core/log/means/log_means.hpp"

#include <gtest/gtest.h>

namespace hagfish::pull_figures_test {

FrameMeans means() {
  FrameMeans mean;
  for (Eigen::VectorXd& force : mean.force.of_kind) force = Eigen::VectorXd::Zero(root_dofs + 3);
  mean.active_torque = Eigen::VectorXd::Zero(root_dofs + 3);
  mean.sum_of_rows = 100;
  mean.force[RowKind::head][0] = -250;
  // Two bodies against the plate at (y, z) = (1, 2) and (-3, 0.5), with 100 and 140 dyn.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& [point, force] :
       {std::pair(Eigen::Vector3d(0, 1, 2), 100.0), {Eigen::Vector3d(0, -3, 0.5), 140.0}}) {
    mean.force[RowKind::obstacle][0] += force;
    moment += point.cross(Eigen::Vector3d(force, 0, 0));
  }
  mean.force[RowKind::obstacle].segment<3>(3) = moment;
  // At the root, no torque of a hinge; in opposite directions at the second hinge.
  mean.active_torque << 900, 0, 0, 0, 0, 0, 50, -70, 10;
  mean.force[RowKind::thigmotaxis] << 0, 0, 0, 0, 0, 0, 12.5, 30, -60;
  return mean;
}

TEST(PullFigures, AreThoseOfTheirMeans) {
  const PullFigures pull = pull_figures(means());
  EXPECT_EQ(pull.force, 250);
  EXPECT_EQ(pull.plate, 240);
  EXPECT_NEAR(pull.bearing[0], (100 * 1 - 140 * 3) / 240.0, 1e-14);
  EXPECT_NEAR(pull.bearing[1], (100 * 2 + 140 * 0.5) / 240.0, 1e-14);
  EXPECT_EQ(pull.torque, 62.5);
  EXPECT_EQ(pull.advantage_rows, 2.5);
  EXPECT_EQ(pull.advantage_torque, 4);
}

TEST(PullFigures, HaveNoAdvantageWhereNothingPushes) {
  FrameMeans mean = means();
  mean.sum_of_rows = 0;
  mean.force[RowKind::obstacle].setZero();
  mean.force[RowKind::thigmotaxis] = -mean.active_torque;
  const PullFigures pull = pull_figures(mean);
  EXPECT_EQ(pull.force, 250);
  for (const double none :
       {pull.bearing[0], pull.bearing[1], pull.advantage_rows, pull.advantage_torque}) {
    EXPECT_TRUE(std::isnan(none));
  }
}

}  // namespace hagfish::pull_figures_test
