#include "core/chain/joint_moments.hpp"

#include <gtest/gtest.h>

#include "core/log/means/moment_means.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::joint_moments_test {

constexpr double rounding = 1e-12;

/// The axis of a hinge in the axes of its joint.
Eigen::Vector3d own_axis(const Kinematics& kin, const std::vector<Eigen::Matrix3d>& axes, int body,
                         int dof) {
  return axes[body] * kin.axis.col(dof).head<3>();
}

TEST(JointMoments, AHingesTorqueIsThePartAboutItsAxis) {
  Random random(71);
  for (int trial = 0; trial < 20; ++trial) {
    const Model model = random_chain(random, 8);
    const Kinematics kin = kinematics(model, random_state(random, model, 1));
    const std::vector<Eigen::Matrix3d> axes = axes_of_joints(kin);
    const Matrix6Xd wrench =
        random_entries(random, 6 * model.body_count()).reshaped(6, model.body_count());
    const Eigen::VectorXd torque = generalised_force(model, kin, wrench);
    Eigen::Matrix3Xd moment = Eigen::Matrix3Xd::Zero(3, model.body_count());
    add_moments(kin, wrench, axes, moment);
    for (int k = root_dofs; k < model.nv(); ++k) {
      const int body = model.hinges[k - root_dofs].body;
      EXPECT_NEAR(own_axis(kin, axes, body, k).dot(moment.col(body)), torque[k],
                  rounding * (1 + moment.col(body).norm()) * model.length());
    }
  }
}

// A universal joint's axes are at right angles, so that its torques are parts of one vector.
TEST(JointMoments, TorquesOfAUniversalJointAreOneVectorWithoutAPartAcross) {
  Random random(72);
  const Model fish = table1_hagfish();
  const Kinematics kin = kinematics(fish, random_state(random, fish, 0.3));
  const std::vector<Eigen::Matrix3d> axes = axes_of_joints(kin);
  const Eigen::VectorXd torque = random_entries(random, fish.nv());
  Eigen::Matrix3Xd moment = Eigen::Matrix3Xd::Zero(3, fish.body_count());
  add_hinge_moments(fish, kin, torque, axes, moment);
  for (int b = 1; b < fish.body_count(); ++b) {
    const auto own = torque.segment(fish.bodies[b].first_dof, fish.bodies[b].dofs);
    EXPECT_NEAR(moment.col(b).norm(), own.norm(), rounding);
    for (int k = fish.bodies[b].first_dof; k < fish.bodies[b].first_dof + fish.bodies[b].dofs;
         ++k) {
      EXPECT_NEAR(own_axis(kin, axes, b, k).dot(moment.col(b)), torque[k], rounding);
    }
  }
}

TEST(JointMoments, AxesAreHalfwayAndCurvatureIsTheTurnOverItsSpan) {
  Random random(73);
  const Model fish = table1_hagfish();
  const Kinematics kin = kinematics(fish, random_state(random, fish, 0.3));
  const std::vector<Eigen::Matrix3d> axes = axes_of_joints(kin);
  const Eigen::Matrix3Xd curvature = joint_curvature(fish, kin);
  for (int b = 1; b < fish.body_count(); ++b) {
    const Eigen::Vector3d turn = curvature.col(b) * hinge_span(fish, b);
    const auto turned = [&](double share) {
      return Eigen::AngleAxisd(share * turn.norm(), turn.normalized()).toRotationMatrix();
    };
    EXPECT_TRUE(kin.rotation[b].isApprox(kin.rotation[b - 1] * turned(1), rounding));
    EXPECT_TRUE(axes[b].transpose().isApprox(kin.rotation[b - 1] * turned(0.5), rounding));
  }
  EXPECT_TRUE(joint_curvature(fish, kinematics(fish, rest_state(fish))).isZero(0));
}

// Two equal and opposite forces on two bodies bend what is between them by their couple, and
// nothing else.
TEST(JointMoments, OfAStepAreThoseOfItsRows) {
  const Model fish = table1_hagfish();
  StepRecord record;
  record.after.state = rest_state(fish);
  record.after.observation.kin = kinematics(fish, record.after.state);
  record.solution.force[RowKind::limit].setZero(fish.nv());
  record.solution.active_torque.setZero(fish.nv());
  Row row;
  row.kind = RowKind::thigmotaxis;
  row.shape = BetweenPoints{Eigen::Vector3d::UnitY(), {30, 1, {1}, 30}, {60, 1, {1}, 60}, {}, {}};
  TimeSettings time;
  time.step = 0.005;
  constexpr double force = 7;
  record.solution.rows = {row};
  record.solution.lambda = Eigen::VectorXd::Constant(1, force * time.step);
  MomentMeans means(fish);
  means.take(fish, time, record);
  record.solution.lambda *= 3;
  means.take(fish, time, record);
  const JointMoments& mean = means.close();
  const double length = fish.length() / fish.body_count();
  for (int b = 0; b < fish.body_count(); ++b) {
    // -2 F y at body 60, and the opposite at body 30, as means of F and 3 F.
    const double arm = b <= 30 ? 30 : b <= 60 ? 60.5 - b : 0;
    const Eigen::Vector3d wanted(0, 0, -2 * force * length * arm);
    EXPECT_TRUE(mean.of_rows[RowKind::thigmotaxis].col(b).isApprox(wanted, 1e-9)) << b;
    EXPECT_TRUE(mean.of_rows[RowKind::contact].col(b).isZero(0));
  }
  EXPECT_TRUE(means.close().active.array().isNaN().all());
}

}  // namespace hagfish::joint_moments_test
