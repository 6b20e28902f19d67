#include "core/chain/dynamics.hpp"

#include <gtest/gtest.h>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::dynamics_test {

// Central differences over ±1e-5: truncation and rounding come to some 1e-8 of the largest rate.
constexpr double step = 1e-5;
constexpr double difference_tolerance = 1e-7;
// Sums over a dozen bodies of products of six.
constexpr double rounding = 1e-12;

Eigen::MatrixXd mass_matrix(const Model& model, const Kinematics& kin) {
  return dense(model, kin, {body_inertias(model, kin), Eigen::VectorXd::Zero(model.nv())});
}

Eigen::VectorXd bias_force(const Model& model, const State& state) {
  const Kinematics kin = kinematics(model, state);
  return generalised_force(model, kin, bias_wrench(model, kin, motion_of(kin)));
}

TEST(Dynamics, KineticEnergyIsThatOfTheBodiesAndOfTheMassMatrix) {
  Random random(41);
  for (int trial = 0; trial < 10; ++trial) {
    const Model model = random_chain(random, 10);
    const State state = random_state(random, model, 1);
    const Kinematics kin = kinematics(model, state);
    double energy = 0;
    for (int b = 0; b < model.body_count(); ++b) {
      const Eigen::Vector3d omega = kin.rotation[b].transpose() * kin.twist.col(b).head<3>();
      const Eigen::Vector3d velocity = point_velocity(kin.twist.col(b), kin.centre_offset(b));
      energy += 0.5 * model.bodies[b].mass * velocity.squaredNorm() +
                0.5 * omega.dot(model.bodies[b].inertia.cwiseProduct(omega));
    }
    EXPECT_NEAR(kinetic_energy(model, kin) / energy, 1, rounding);
    EXPECT_NEAR(0.5 * state.qdot.dot(mass_matrix(model, kin) * state.qdot) / energy, 1, rounding);
  }
}

TEST(Dynamics, KineticEnergiesOfAStateAreThoseOfItsKinematics) {
  Random random(13);
  const Model model = random_chain(random, 12);
  const State state = random_state(random, model);
  const Kinematics kin = kinematics(model, state);
  Eigen::VectorXd energies;
  kinetic_energies(model, state, energies);
  ASSERT_EQ(energies.size(), 12);
  for (int b = 0; b < 12; ++b) {
    const double energy =
        kinetic_energy(model, kin, b, kin.twist.col(b), kin.centre_velocity.col(b));
    EXPECT_NEAR(energies[b], energy, 1e-12 * energy) << b;  // rounding of 12 bodies' velocities
  }
}

// A bias that is to have a power takes as much of each body's momentum as gives it that.
TEST(Dynamics, BiasHasThePowerThatItIsGiven) {
  Random random(12);
  const Model model = random_chain(random, 12);
  const State state = random_state(random, model);
  const Kinematics kin = kinematics(model, state);
  const Matrix6Xd mean =
      body_twists(model, kin, state.qdot + random_entries(random, model.nv(), 0.5));
  BiasPower power{random_entries(random, 12, 100), 0};
  StepMotion motion{kin.twist, kin.centre_velocity, mean};
  const Matrix6Xd plain = bias_wrench(model, kin, motion);
  motion.bias_power = &power;
  const Matrix6Xd given = bias_wrench(model, kin, motion);
  for (int b = 0; b < 12; ++b) {
    const Vector6d momentum = body_inertia(model, kin, b) * mean.col(b);
    const Vector6d added = given.col(b) - plain.col(b);
    const double share = added.dot(momentum) / momentum.squaredNorm();
    EXPECT_LT((added - share * momentum).norm(), 1e-12 * added.norm()) << b;
    EXPECT_NEAR(given.col(b).dot(kin.twist.col(b)), power.value[b], 1e-10) << b;
  }
  power.least = 1e9;  // far more than any body has
  EXPECT_LT((bias_wrench(model, kin, motion) - plain).norm(), 1e-6 * plain.norm());
}

TEST(Dynamics, DragIsItsIntegralAlongTheBody) {
  Random random(47);
  const Model model = random_chain(random, 6);
  const Kinematics kin = kinematics(model, random_state(random, model, 1));
  for (int b = 0; b < model.body_count(); ++b) {
    const double length = model.bodies[b].length;
    const Eigen::Vector3d along = kin.rotation[b].col(0);
    const Vector6d twist = random_entries(random, 6);
    // Force per length is linear along the body and its moment quadratic: Simpson's rule is exact.
    Vector6d expected = Vector6d::Zero();
    for (const auto& [place, weight] : {std::pair{-0.5, 1.0}, {0.0, 4.0}, {0.5, 1.0}}) {
      const Eigen::Vector3d offset = kin.centre_offset(b) + place * length * along;
      const Eigen::Vector3d velocity = point_velocity(twist, offset);
      const Eigen::Vector3d axial = along.dot(velocity) * along;
      const Eigen::Vector3d force =
          model.drag.normal * (velocity - axial) + model.drag.tangential * axial;
      expected += weight / 6 * length * wrench_of_force(force, offset);
    }
    EXPECT_LT(relative_error(drag_operator(model, kin, b) * twist, expected), 1e-13);
  }
}

TEST(Dynamics, ForcesAreGradientsOfTheirEnergies) {
  Random random(48);
  for (int trial = 0; trial < 10; ++trial) {
    const Model model = random_chain(random, 10);
    const State state = random_state(random, model, 1);
    const Kinematics kin = kinematics(model, state);
    const Eigen::VectorXd gravity = generalised_force(model, kin, gravity_wrench(model, kin));
    const Eigen::VectorXd stiffness = stiffness_force(model, state.q);
    Eigen::VectorXd gravity_slope(model.nv());
    Eigen::VectorXd stiffness_slope(model.nv());
    for (int k = 0; k < model.nv(); ++k) {
      const Eigen::VectorXd along = Eigen::VectorXd::Unit(model.nv(), k);
      const Eigen::VectorXd up = advance(state.q, along, step);
      const Eigen::VectorXd down = advance(state.q, along, -step);
      gravity_slope[k] = (gravity_energy(model, kinematics(model, {up, along})) -
                          gravity_energy(model, kinematics(model, {down, along}))) /
                         (2 * step);
      stiffness_slope[k] = (elastic_energy(model, up) - elastic_energy(model, down)) / (2 * step);
    }
    EXPECT_LT(relative_error(gravity, -gravity_slope), difference_tolerance);
    EXPECT_LT(relative_error(stiffness, -stiffness_slope), difference_tolerance);
  }
}

// Eq. 1 with everything dense: H = M + h D - h² K and g = M q̇0 + h f.
TEST(Dynamics, StepSystemIsEquationOneOfThePaper) {
  Random random(49);
  for (int trial = 0; trial < 10; ++trial) {
    const Model model = random_chain(random, 9);
    const State state = random_state(random, model, 1);
    const Kinematics kin = kinematics(model, state);
    const double h = 0.013;
    const TipForce tip{random_vector(random, 1000), 40};

    const Eigen::MatrixXd mass = mass_matrix(model, kin);
    Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(model.nv(), model.nv());
    Eigen::VectorXd force = generalised_force(model, kin, gravity_wrench(model, kin)) -
                            bias_force(model, state) + stiffness_force(model, state.q);
    for (int b = 0; b < model.body_count(); ++b) {
      const Matrix6Xd jacobian = body_jacobian(model, kin, b);
      damping += jacobian.transpose() * drag_operator(model, kin, b) * jacobian;
    }
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(model.nv(), model.nv());
    for (int k = root_dofs; k < model.nv(); ++k) {
      damping(k, k) += model.hinges[k - root_dofs].damping;
      stiffness(k, k) = -model.hinges[k - root_dofs].stiffness;
    }
    const Eigen::Matrix3Xd last = centre_jacobian(model, kin, model.body_count() - 1);
    damping += tip.rate * last.transpose() * last;
    force += last.transpose() * tip.value;

    const StepSystem system = step_system(model, state, kin, tip, h);
    EXPECT_LT(relative_error(dense(model, kin, system.op), mass + h * damping - h * h * stiffness),
              rounding);
    EXPECT_LT(relative_error(generalised_force(model, kin, system.wrench) + system.joint,
                             mass * state.qdot + h * force),
              rounding);
  }
}

}  // namespace hagfish::dynamics_test
