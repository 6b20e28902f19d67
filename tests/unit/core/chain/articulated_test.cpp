#include "core/chain/articulated.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <stdexcept>
#include <string>

#include "core/chain/dynamics.hpp"
#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::articulated_test {

// Sums over a dozen bodies of products of six: some 100 roundings of entries of one size.
constexpr double rounding = 1e-13;

/// J' Î J + diag(δ) by the definition of RedMax.
Eigen::MatrixXd definition(const Model& model, const Kinematics& kin, const StepOperator& op) {
  Eigen::MatrixXd h = op.diagonal.asDiagonal();
  for (int b = 0; b < model.body_count(); ++b) {
    const Matrix6Xd jacobian = body_jacobian(model, kin, b);
    h += jacobian.transpose() * op.inertia[b].matrix() * jacobian;
  }
  return h;
}

struct Case {
  Model model;
  Kinematics kin;
  StepOperator op;
};

Case random_case(Random& random, int bodies) {
  Case c;
  c.model = random_chain(random, bodies);
  c.kin = kinematics(c.model, random_state(random, c.model, 1));
  c.op = random_operator(random, c.model, c.kin);
  return c;
}

/// The hagfish with the operator of a step of 2 ms.
Case hagfish_case(Random& random, int bodies) {
  Case c;
  c.model = table1_hagfish(bodies);
  const State state = random_state(random, c.model, 0.2);
  c.kin = kinematics(c.model, state);
  c.op = step_system(c.model, state, c.kin, {Eigen::Vector3d::Zero(), 10}, 2e-3).op;
  return c;
}

TEST(Articulated, DenseIsRedMaxsDefinition) {
  Random random(31);
  for (const int bodies : {1, 2, 3, 7, 12}) {
    for (int trial = 0; trial < 5; ++trial) {
      const Case c = random_case(random, bodies);
      EXPECT_LT(relative_error(dense(c.model, c.kin, c.op), definition(c.model, c.kin, c.op)),
                rounding);
    }
  }
  const Case fish = hagfish_case(random, 100);
  EXPECT_LT(relative_error(dense(fish.model, fish.kin, fish.op),
                           definition(fish.model, fish.kin, fish.op)),
            rounding);
}

TEST(Articulated, MultiplyIsTheDenseProduct) {
  Random random(32);
  for (const int bodies : {1, 2, 3, 12, 100}) {
    const Case c = random_case(random, bodies);
    const Eigen::VectorXd v = random_entries(random, c.model.nv());
    EXPECT_LT(
        relative_error(multiply(c.model, c.kin, c.op, v), definition(c.model, c.kin, c.op) * v),
        rounding);
  }
}

enum class Prescribed { none, hinges, head_and_hinges };

/// Every third velocity of hinges, and the first six of the head, where these are prescribed.
std::vector<PrescribedVelocity> some_prescribed(Random& random, const Model& model, Prescribed of) {
  std::vector<PrescribedVelocity> prescribed;
  for (int k = 0; k < model.nv(); ++k) {
    const Prescribed from = k < root_dofs ? Prescribed::head_and_hinges : Prescribed::hinges;
    if (of >= from && (k < root_dofs || k % 3 == 0)) {
      prescribed.push_back({k, random_entries(random, 1)[0]});
    }
  }
  return prescribed;
}

/// What is left of H where velocities are prescribed: their rows and columns out, 1 on the
/// diagonal.
Eigen::MatrixXd without(Eigen::MatrixXd h, const std::vector<PrescribedVelocity>& prescribed) {
  for (const PrescribedVelocity& velocity : prescribed) {
    h.row(velocity.dof).setZero();
    h.col(velocity.dof).setZero();
    h(velocity.dof, velocity.dof) = 1;
  }
  return h;
}

TEST(Articulated, SolvesHoldsVelocitiesAndTellsTheForces) {
  Random random(37);
  for (const int bodies : {1, 2, 3, 12}) {
    for (const Prescribed of :
         {Prescribed::none, Prescribed::hinges, Prescribed::head_and_hinges}) {
      const Case c = random_case(random, bodies);
      const std::vector<PrescribedVelocity> prescribed = some_prescribed(random, c.model, of);
      ArticulatedFactor factor;
      factor.factorise(c.model, c.kin, c.op, prescribed);
      const Eigen::VectorXd joint = random_entries(random, c.model.nv());
      const Matrix6Xd wrench = random_entries(random, 6 * bodies).reshaped(6, bodies);
      Eigen::VectorXd v, holding;
      Matrix6Xd twist;
      factor.solve(c.model, c.kin, wrench, joint, v, twist, holding);
      const Eigen::MatrixXd h = definition(c.model, c.kin, c.op);
      const Eigen::VectorXd right = generalised_force(c.model, c.kin, wrench) + joint;
      Eigen::VectorXd given = Eigen::VectorXd::Zero(c.model.nv());
      for (const PrescribedVelocity& velocity : prescribed) given[velocity.dof] = velocity.value;
      Eigen::VectorXd rest = right - h * given;
      for (const PrescribedVelocity& velocity : prescribed) rest[velocity.dof] = 0;
      const Eigen::VectorXd expected = given + without(h, prescribed).llt().solve(rest);
      // H of a dozen small bodies has a condition of up to 1e5.
      EXPECT_LT(relative_error(v, expected), 1e-10);
      EXPECT_LT(relative_error(twist, body_twists(c.model, c.kin, v)), rounding);
      const Eigen::VectorXd force = h * expected - right;
      ASSERT_EQ(holding.size(), static_cast<Eigen::Index>(prescribed.size()));
      const double scale = force.lpNorm<Eigen::Infinity>() + right.lpNorm<Eigen::Infinity>();
      for (std::size_t i = 0; i < prescribed.size(); ++i) {
        EXPECT_EQ(v[prescribed[i].dof], prescribed[i].value);
        EXPECT_NEAR(holding[static_cast<Eigen::Index>(i)], force[prescribed[i].dof], 1e-10 * scale);
      }
    }
  }
}

TEST(Articulated, PivotIsTheInverseMobilityOverAFixedBase) {
  Random random(39);
  const Case c = random_case(random, 6);
  ArticulatedFactor factor;
  factor.factorise(c.model, c.kin, c.op);
  const Eigen::MatrixXd h = definition(c.model, c.kin, c.op);
  for (int k = 0; k < c.model.nv(); ++k) {
    const Eigen::Index rest = c.model.nv() - k;
    const Eigen::MatrixXd mobility = h.bottomRightCorner(rest, rest).inverse();
    EXPECT_NEAR(factor.pivot(k) * mobility(0, 0), 1, 1e-10) << k;
  }
}

TEST(Articulated, IsAccurateAtEveryBodyCount) {
  // The error of a backward stable solve is the condition of H times rounding: measured 6e-14,
  // 8e-14, 1e-12, 1e-10 and 1e-9, bounds ten times that. The residual stays at rounding.
  struct Row {
    int bodies;
    double error;
  };
  for (const Row& row : {Row{2, 1e-12}, {3, 1e-12}, {10, 1e-11}, {100, 1e-9}, {400, 1e-8}}) {
    Random random(35);
    const Case c = hagfish_case(random, row.bodies);
    ArticulatedFactor factor;
    factor.factorise(c.model, c.kin, c.op);
    const Eigen::VectorXd v = random_entries(random, c.model.nv());
    const Eigen::VectorXd right = dense(c.model, c.kin, c.op) * v;
    const Eigen::VectorXd x = factor.solve(c.model, c.kin, Matrix6Xd::Zero(6, row.bodies), right);
    const double error = relative_error(x, v);
    const double residual = relative_error(multiply(c.model, c.kin, c.op, x), right);
    EXPECT_LT(error, row.error) << row.bodies << " bodies";
    EXPECT_LT(residual, 1e-13) << row.bodies << " bodies";
    // No worse than dense LLT by more than a digit.
    const Eigen::VectorXd reference = dense(c.model, c.kin, c.op).llt().solve(right);
    EXPECT_LT(error, 10 * relative_error(reference, v)) << row.bodies << " bodies";
  }
}

TEST(Articulated, ThrowsWhereTheOperatorIsNotPositive) {
  Random random(36);
  const Case good = random_case(random, 6);
  ArticulatedFactor factor;
  EXPECT_NO_THROW(factor.factorise(good.model, good.kin, good.op));

  Case massless = good;
  for (PaddedOperator& inertia : massless.op.inertia) inertia = {};
  massless.op.diagonal.setZero();
  EXPECT_THROW(factor.factorise(massless.model, massless.kin, massless.op), std::domain_error);

  Case negative = good;
  negative.op.diagonal[7] = -1e6;
  try {
    factor.factorise(negative.model, negative.kin, negative.op);
    FAIL() << "a negative pivot went through";
  } catch (const std::domain_error& error) {
    EXPECT_NE(std::string(error.what()).find("velocity 7"), std::string::npos) << error.what();
  }

  Case undefined = good;
  undefined.op.inertia[3].columns(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(factor.factorise(undefined.model, undefined.kin, undefined.op), std::domain_error);
}

}  // namespace hagfish::articulated_test
