// The total angle of a universal joint against the kinematics, and the rows that bound it.
#include "core/chain/bending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::bending_test {

constexpr double h = 2e-3;
const ConstraintSettings speculative;

/// X axis of a joint's second body in the frame of its first, by the kinematics.
Eigen::Vector3d second_axis(const Model& model, const Eigen::VectorXd& q, int body) {
  Kinematics kin;
  update_positions(model, q, kin);
  return kin.rotation[body - 1].transpose() * kin.rotation[body].col(0);
}

/// The angle between the X axes of a joint's two bodies, by the kinematics.
double angle_of(const Model& model, const Eigen::VectorXd& q, int body) {
  const Eigen::Vector3d axis = second_axis(model, q, body);
  return std::atan2(std::hypot(axis.y(), axis.z()), axis.x());
}

Eigen::Vector2d random_angles(Random& random, double size = 1.4) {
  return random_entries(random, 2, size);
}

TEST(Bend, IsTheAngleBetweenTheBodies) {
  const Model model = cone_hagfish(2);
  State state = rest_state(model);
  Random random(1);
  for (const double size : {1.4, 1e-3, 1e-9}) {
    for (int k = 0; k < 100; ++k) {
      state.q.tail<2>() = random_angles(random, size);
      const Bend bend = total_bend(state.q[7], state.q[8]);
      // A few roundings of sines and of unit vectors.
      EXPECT_NEAR(bend.angle, angle_of(model, state.q, 1), 1e-15 * (1 + size));
      EXPECT_NEAR(std::cos(bend.angle), std::cos(state.q[7]) * std::cos(state.q[8]), 1e-15);
    }
  }
}

TEST(Bend, IsWellBehavedWhereTheJointIsStraight) {
  EXPECT_EQ(total_bend(0, 0).angle, 0);
  EXPECT_EQ(total_bend(0, 0).slope, Eigen::Vector2d::Zero());
  for (const double tiny : {1e-6, 1e-12, 1e-300}) {
    const Bend bend = total_bend(3 * tiny, -4 * tiny);
    EXPECT_NEAR(bend.angle / tiny, 5, 1e-11);  // of fourth order off a plane, and rounding
    EXPECT_LT((bend.slope - Eigen::Vector2d(0.6, -0.8)).norm(), 1e-11);
  }
}

TEST(Bend, GoesAsFarAsToldTheSameWay) {
  const Model model = cone_hagfish(2);
  State state = rest_state(model);
  Random random(3);
  int in_plane = 0;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector2d angles = random_angles(random, 3);  // also past 90 degrees
    const double wanted = uniform(random, 1e-3, 1.5);
    state.q.tail<2>() = angles;
    const Eigen::Vector3d before = second_axis(model, state.q, 1);
    state.q.tail<2>() = bend_to(angles[0], angles[1], wanted);
    const Eigen::Vector3d after = second_axis(model, state.q, 1);
    EXPECT_NEAR(angle_of(model, state.q, 1), wanted, 1e-14);
    EXPECT_TRUE((state.q.tail<2>().array() * angles.array() > 0).all());
    if (angles.lpNorm<Eigen::Infinity>() <= wanted) {
      ++in_plane;  // rounding over the sine of the bend before
      EXPECT_LT((before.tail<2>().normalized() - after.tail<2>().normalized()).norm(), 1e-13);
    }
  }
  EXPECT_GT(in_plane, 5);
}

TEST(Bend, PastItsConeStaysSoWhereTheAxesComeTogetherAgain) {
  const Model model = cone_hagfish(2);
  Eigen::VectorXd q = rest_state(model).q;
  const BendingCone cone{root_dofs, 1};
  q.tail<2>() << -2.5, 3;
  EXPECT_LT(angle_of(model, q, 1), 1);
  EXPECT_EQ(past_cone(cone, q), 2);
  q.tail<2>() << 0.6, -0.5;
  EXPECT_EQ(past_cone(cone, q), 0);
  q.tail<2>() << 0.8, -0.9;
  EXPECT_EQ(past_cone(cone, q), total_bend(0.8, -0.9).angle - 1);
  q.tail<2>() << 0.72, -0.72;  // outside the circle of its radius, but not of the cone
  EXPECT_EQ(past_cone(cone, q), 0);
}

TEST(Bend, TangentsDoNotCutTheCone) {
  Random random(4);
  for (int k = 0; k < 1000; ++k) {
    const double limit = uniform(random, 0.1, 1.5);
    const Eigen::Vector2d there = random_angles(random);
    const Eigen::Vector2d within = bend_to(there[0], there[1], uniform(random, 0, limit));
    const Eigen::Vector2d other = random_angles(random);
    const Eigen::Vector2d touch = bend_to(other[0], other[1], limit);
    EXPECT_LE(total_bend(touch[0], touch[1]).slope.dot(within - touch), 1e-14);
  }
}

TEST(ConeRows, AreTheRateOfWhatTheConeLeaves) {
  const Model model = cone_hagfish();
  Random random(5);
  State state = random_state(random, model);
  state = within_cones(model, state, 1.2);  // some of them past it
  const Kinematics kin = kinematics(model, state);
  int cones = 0;
  for (const Row& row : limit_rows(model, state, speculative, h)) {
    const int body = model.hinges[row.joint()->dof - root_dofs].body;
    if (model.bodies[body].dofs != 2) continue;
    ++cones;
    const auto found = std::ranges::find(model.cones, row.joint()->dof, &BendingCone::dof);
    ASSERT_NE(found, model.cones.end());
    const double gap = found->limit - angle_of(model, state.q, body);
    // Sines and cosines side by side are known to 4 units in the last place: 4e-15 / h.
    EXPECT_NEAR(row.rhs, gap >= 0 ? -gap / h : -0.5 * gap / h, 4e-12);
    EXPECT_EQ(row.kind, RowKind::limit);
    EXPECT_EQ(row.lower, 0);
    EXPECT_TRUE(std::isinf(row.upper));
    const double e = 1e-6;
    const double rate = (angle_of(model, advance(state.q, state.qdot, e), body) -
                         angle_of(model, advance(state.q, state.qdot, -e), body)) /
                        (2 * e);
    // Rounding over 2e-6, and 1e-12 times the third derivative.
    EXPECT_NEAR(row_velocity(row, kin.velocities(), state.qdot), -rate, 1e-8);
  }
  EXPECT_EQ(cones, 50);
}

TEST(ConeRows, StandInForTheFourOfABox) {
  const Model model = cone_hagfish();
  Random random(6);
  const State state = random_state(random, model, 0.1);
  const std::vector<Row> rows = limit_rows(model, state, speculative, h);
  EXPECT_EQ(rows.size(), 49U * 2 + 50U);  // twist limits as ever
  std::set<std::string> names;
  for (const Row& row : rows) names.insert(row_name(model, row));
  EXPECT_TRUE(names.contains("bending limit of j05_bend (total angle)"));
  EXPECT_TRUE(names.contains("upper limit of j02_twist"));
  // A straight joint has no direction in which it could pass its cone.
  EXPECT_EQ(limit_rows(model, rest_state(model), speculative, h).size(), 49U * 2);
  ConstraintSettings violated;
  violated.activation = Activation::violated;
  EXPECT_TRUE(limit_rows(model, state, violated, h).empty());
}

}  // namespace hagfish::bending_test
