#include "core/chain/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::model_test {

// Sums of up to 400 terms of one size: 400 roundings.
constexpr double sum_rounding = 1e-13;

constexpr double degree = std::numbers::pi / 180;

TEST(Model, NumbersVelocitiesHeadToTail) {
  Model model;
  append_body(model, {}, {});
  append_body(model, {}, {Axis::y, Axis::z});
  append_body(model, {}, {});
  append_body(model, {}, {Axis::x, Axis::z, Axis::y});

  EXPECT_EQ(model.nv(), 11);
  EXPECT_EQ(model.nq(), 12);
  const int first[] = {0, 6, 8, 8};
  const int dofs[] = {6, 2, 0, 3};
  for (int b = 0; b < 4; ++b) {
    EXPECT_EQ(model.bodies[b].first_dof, first[b]) << b;
    EXPECT_EQ(model.bodies[b].dofs, dofs[b]) << b;
  }
  const int body[] = {1, 1, 3, 3, 3};
  const Axis axis[] = {Axis::y, Axis::z, Axis::x, Axis::z, Axis::y};
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(model.hinges[k].body, body[k]) << k;
    EXPECT_EQ(model.hinges[k].axis, axis[k]) << k;
    EXPECT_TRUE(std::isinf(model.hinges[k].lower) && model.hinges[k].lower < 0) << k;
    EXPECT_TRUE(std::isinf(model.hinges[k].upper) && model.hinges[k].upper > 0) << k;
  }
}

TEST(Model, CylinderInertiaIsItsIntegral) {
  // Two-point Gauss-Legendre over the length is exact for x², and a disc has r²/2 and r²/4.
  const double mass = 3;
  const double length = 1.7;
  const double radius = 0.6;
  const double node = 0.5 * length / std::sqrt(3.0);
  const double across = mass * (radius * radius / 4 + node * node);
  const Eigen::Vector3d inertia = cylinder_inertia(mass, length, radius);
  EXPECT_DOUBLE_EQ(inertia.x(), mass * radius * radius / 2);
  EXPECT_DOUBLE_EQ(inertia.y(), across);
  EXPECT_DOUBLE_EQ(inertia.z(), across);
}

TEST(Hagfish, HasThePapersHundredJoints) {
  const Model fish = table1_hagfish();
  ASSERT_EQ(fish.body_count(), 100);
  EXPECT_EQ(fish.nv(), 6 + 2 * 50 + 49);
  for (int b = 1; b < 100; ++b) {
    const Body& body = fish.bodies[b];
    ASSERT_EQ(body.dofs, b % 2 == 1 ? 2 : 1) << b;
    if (b % 2 == 1) {
      const bool z_first = b % 4 == 1;
      EXPECT_EQ(fish.hinges[body.first_dof - root_dofs].axis, z_first ? Axis::z : Axis::y) << b;
      EXPECT_EQ(fish.hinges[body.first_dof - root_dofs + 1].axis, z_first ? Axis::y : Axis::z) << b;
    } else {
      EXPECT_EQ(fish.hinges[body.first_dof - root_dofs].axis, Axis::x) << b;
    }
  }
}

TEST(Hagfish, HasTheMeasuredSizeAtAnyBodyCount) {
  for (const int n : {2, 3, 10, 99, 100, 101, 400}) {
    const Model fish = table1_hagfish(n);
    double mass = 0;
    for (const Body& body : fish.bodies) {
      mass += body.mass;
      const Eigen::Vector3d inertia = cylinder_inertia(body.mass, body.length, body.radius);
      EXPECT_EQ(body.inertia, inertia);
    }
    EXPECT_NEAR(mass, 80, 80 * sum_rounding) << n;
    EXPECT_NEAR(fish.length(), 42.4, 42.4 * sum_rounding) << n;
    ASSERT_EQ(fish.body_count(), n);
  }
}

TEST(Hagfish, IsAsThickAsMeasuredAndSharesMassByVolume) {
  const Model fish = table1_hagfish();
  const double density = 80 / std::accumulate(fish.bodies.begin(), fish.bodies.end(), 0.0,
                                              [](double sum, const Body& body) {
                                                return sum + body.radius * body.radius;
                                              });
  for (const Body& body : fish.bodies) {
    EXPECT_NEAR(body.mass, density * body.radius * body.radius, sum_rounding);
  }
  // Constant outside the stations, linear between them; the middle of body b is at (b + ½) / 100.
  const double turn = 2 * std::numbers::pi;
  EXPECT_NEAR(fish.bodies[0].radius, 5.6 / turn, sum_rounding);
  EXPECT_NEAR(fish.bodies[19].radius, 5.6 / turn, sum_rounding);
  EXPECT_NEAR(fish.bodies[30].radius, (5.6 - 0.1 * 10.5 / 20) / turn, sum_rounding);
  EXPECT_NEAR(fish.bodies[70].radius, (5.6 - 1.3 * 10.5 / 20) / turn, sum_rounding);
  EXPECT_NEAR(fish.bodies[99].radius, 4.3 / turn, sum_rounding);
}

TEST(Hagfish, BendsAsFarAsMeasured) {
  const Model fish = table1_hagfish();
  const auto limit = [&](int body) {
    return fish.hinges[fish.bodies[body].first_dof - root_dofs].upper / degree;
  };
  EXPECT_NEAR(limit(1), 21, 1e-12);
  EXPECT_NEAR(limit(31), 21 + 54 * 11.0 / 20, 1e-12);
  EXPECT_NEAR(limit(51), 75 - 30 * 11.0 / 20, 1e-12);
  EXPECT_NEAR(limit(99), 51, 1e-12);
  EXPECT_NEAR(limit(2), 0.48, 1e-12);  // twist: 48 degrees over 100 bodies (paper, Table 1)
  for (const Hinge& hinge : fish.hinges) {
    EXPECT_EQ(hinge.lower, -hinge.upper);
  }
}

TEST(Hagfish, LimitsAndStiffnessPerLengthDoNotDependOnTheBodyCount) {
  const Specimen specimen = table1_specimen();
  Scene scene = table1_scene();
  scene.model.bending_damping = 7;
  scene.model.twist_damping = 3;
  int capped = 0;
  for (int n = 2; n <= 400; ++n) {
    scene.model.bodies = n;
    const Model fish = make_hagfish(specimen, scene);
    const double span = 2 * 42.4 / n;
    Eigen::Vector3d compliance = Eigen::Vector3d::Zero();  // about x, y, z
    for (const Hinge& hinge : fish.hinges) {
      const bool bend = hinge.axis != Axis::x;
      compliance[static_cast<int>(hinge.axis)] += 1 / hinge.stiffness;
      EXPECT_NEAR(hinge.damping, hinge.stiffness * (bend ? 7 : 3) / 424,
                  hinge.damping * sum_rounding);
      if (hinge.body > 2 && hinge.body + 2 < n) {  // between others of its kind
        EXPECT_NEAR(hinge.stiffness * span, 424, 424 * sum_rounding);
      }
      if (!bend) {
        EXPECT_NEAR(hinge.upper / span, 48 * degree / (2 * 42.4), sum_rounding);
        continue;
      }
      const double measured =
          profile(specimen.station, specimen.bending_limit, static_cast<double>(hinge.body) / n);
      const double curvature = measured / 0.848;
      if (curvature * span > scene.model.largest_limit) {
        EXPECT_EQ(hinge.upper, scene.model.largest_limit);
        ++capped;
      } else {
        EXPECT_NEAR(hinge.upper / span, curvature, 2 * sum_rounding);
      }
    }
    // Of the whole animal; two bodies have no twist.
    const Eigen::Vector3d whole(n == 2 ? 0 : 42.4 / 424, 42.4 / 424, 42.4 / 424);
    EXPECT_LT((compliance - whole).lpNorm<Eigen::Infinity>(), sum_rounding) << n;
  }
  EXPECT_GT(capped, 0);  // the coarse chains
}

TEST(Hagfish, OfUniversalJointsBendsAsFarAndAsStiffly) {
  const Specimen specimen = table1_specimen();
  Scene scene = table1_scene();
  const Model alternating = make_hagfish(specimen, scene);
  scene.model.joints = JointLayout::universal;
  const Model fish = make_hagfish(specimen, scene);
  ASSERT_EQ(fish.hinges.size(), 198U);
  Eigen::Vector3d compliance = Eigen::Vector3d::Zero();
  double most = 0, least = 0;  // of bends of the whole body
  for (const Hinge& hinge : fish.hinges) {
    compliance[static_cast<int>(hinge.axis)] += 1 / hinge.stiffness;
    most += hinge.axis == Axis::y ? hinge.upper : 0;
  }
  for (const Hinge& hinge : alternating.hinges) least += hinge.axis == Axis::y ? hinge.upper : 0;
  EXPECT_LT((compliance - Eigen::Vector3d(0, 42.4 / 424, 42.4 / 424)).norm(), sum_rounding);
  EXPECT_NEAR(most / least, 1, 0.01);  // both are sums over the body's profile
}

TEST(Hagfish, RefusesBodyCountsItCannotStandFor) {
  for (const int n : {-1, 0, 1, 401}) {
    EXPECT_THROW(table1_hagfish(n), std::invalid_argument) << n;
  }
}

TEST(JointNames, FollowTheVelocities) {
  const std::vector<JointName> names = joint_names(table1_hagfish());
  ASSERT_EQ(names.size(), 100U);
  EXPECT_EQ(names[0].joint, "root");
  EXPECT_EQ(names[0].dofs.size(), 6U);
  EXPECT_EQ(names[1].joint, "j01_bend");
  EXPECT_EQ(names[1].dofs, (std::vector<std::string>{"j01_bend_z", "j01_bend_y"}));
  EXPECT_EQ(names[98].joint, "j98_twist");
  EXPECT_EQ(names[98].dofs, (std::vector<std::string>{"j98_twist"}));
  EXPECT_EQ(joint_names(table1_hagfish(101))[7].joint, "j007_bend");
}

TEST(Hagfish, MassRatioIsGeometricAndKeepsTheWhole) {
  const auto [scene, animal, fish] = stored_scene({"model.mass_ratio=10000"});
  const Model even = table1_hagfish();
  const double first = fish.bodies.front().mass / even.bodies.front().mass;
  const int last = fish.body_count() - 1;
  double whole = 0;
  for (int b = 0; b <= last; ++b) {
    const double share = fish.bodies[b].mass / even.bodies[b].mass / first;
    EXPECT_NEAR(share / std::pow(1e4, double(b) / last), 1, sum_rounding) << b;
    whole += fish.bodies[b].mass;
  }
  EXPECT_NEAR(whole / animal.mass, 1, sum_rounding);
}

TEST(Hagfish, LimitScaleIsOnEveryLimitBelowTheLargest) {
  const auto [scene, animal, fish] = stored_scene({"model.limit_scale=1.5"});
  const Model even = table1_hagfish();
  for (std::size_t k = 0; k < fish.hinges.size(); ++k) {
    const double scaled = std::min(1.5 * even.hinges[k].upper, scene.model.largest_limit);
    // The two sides round twice each.
    EXPECT_NEAR(fish.hinges[k].upper,
                fish.hinges[k].axis == Axis::x ? 1.5 * even.hinges[k].upper : scaled, 1e-15)
        << k;
    EXPECT_EQ(fish.hinges[k].lower, -fish.hinges[k].upper) << k;
  }
}

}  // namespace hagfish::model_test
