#include "core/contact/spline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish::spline_test {

// Mixes of four points of some 10 cm: a few roundings.
constexpr double rounding = 1e-13;

struct Curve {
  Model model;
  Kinematics kin;
  std::vector<SplineSegment> segments;
};

Curve random_curve(Random& random, int bodies) {
  Curve c;
  c.model = random_chain(random, bodies);
  c.kin = kinematics(c.model, random_state(random, c.model, 1));
  c.segments = spline(c.model, c.kin.centre);
  return c;
}

TEST(Spline, PassesThroughTheBodyCentresWithTheirRadii) {
  Random random(51);
  for (const int bodies : {2, 3, 4, 15}) {
    const Curve c = random_curve(random, bodies);
    ASSERT_EQ(c.segments.size(), static_cast<std::size_t>(bodies - 1));
    for (int i = 0; i + 1 < bodies; ++i) {
      const SplineSegment& s = c.segments[i];
      EXPECT_LT((s.point(0) - c.kin.centre.col(i)).norm(), rounding);
      EXPECT_LT((s.point(1) - c.kin.centre.col(i + 1)).norm(), rounding);
      EXPECT_NEAR(s.radius(0), c.model.bodies[i].radius, rounding);
      EXPECT_NEAR(s.radius(1), c.model.bodies[i + 1].radius, rounding);
    }
  }
}

TEST(Spline, IsTheMixOfBodyCentresThatSplineMixGives) {
  Random random(52);
  for (const int bodies : {2, 3, 4, 15}) {
    const Curve c = random_curve(random, bodies);
    for (int i = 0; i + 1 < bodies; ++i) {
      for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        const SplineMix mix = spline_mix(i, t, bodies);
        ASSERT_GE(mix.first, 0);
        ASSERT_LE(mix.first + mix.count, bodies);
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        double sum = 0;
        for (int k = 0; k < mix.count; ++k) {
          point += mix.weight[k] * c.kin.centre.col(mix.first + k);
          sum += mix.weight[k];
        }
        EXPECT_NEAR(sum, 1, 1e-15);  // four numbers below 1
        EXPECT_LT((point - c.segments[i].point(t)).norm(), rounding) << i << " of " << bodies;
      }
    }
  }
}

TEST(Spline, IsSmoothAcrossSegments) {
  Random random(53);
  const Curve c = random_curve(random, 15);
  for (std::size_t i = 0; i + 1 < c.segments.size(); ++i) {
    EXPECT_LT((c.segments[i].point(1) - c.segments[i + 1].point(0)).norm(), rounding);
    EXPECT_LT((c.segments[i].slope(1) - c.segments[i + 1].slope(0)).norm(), rounding);
  }
}

TEST(Spline, SlopeAndBendAreDerivatives) {
  // Central differences of a cubic: truncation c3 e² ~ 1e-8, rounding 1e-15 / 1e-4.
  Random random(54);
  const Curve c = random_curve(random, 15);
  const double e = 1e-4;
  for (const SplineSegment& s : c.segments) {
    for (const double t : {0.2, 0.9}) {
      EXPECT_LT((s.slope(t) - (s.point(t + e) - s.point(t - e)) / (2 * e)).norm(), 1e-7);
      EXPECT_LT((s.bend(t) - (s.slope(t + e) - s.slope(t - e)) / (2 * e)).norm(), 1e-7);
    }
  }
}

TEST(Spline, BoundHoldsTheSkin) {
  Random random(55);
  for (int trial = 0; trial < 20; ++trial) {
    const Curve c = random_curve(random, 15);
    for (const SplineSegment& s : c.segments) {
      double reach = 0;
      for (int k = 0; k <= 200; ++k) {
        const double t = k / 200.0;
        reach = std::max(reach, (s.point(t) - s.middle).norm() + s.radius(t));
      }
      EXPECT_LE(reach, s.bound + rounding);
      // Not a trivially large bound: the chord and the Bézier points come near the skin.
      EXPECT_LT(s.bound, 1.5 * reach);
    }
  }
}

TEST(Spline, EndsPointAlongTheOutermostBodies) {
  // The polygon continues straight beyond both ends, so the slope there is the chord.
  Random random(56);
  const Curve c = random_curve(random, 15);
  const Eigen::Matrix3Xd& x = c.kin.centre;
  EXPECT_LT((c.segments.front().slope(0) - (x.col(1) - x.col(0))).norm(), rounding);
  EXPECT_LT((c.segments.back().slope(1) - (x.col(14) - x.col(13))).norm(), rounding);
}

TEST(Spline, ArcLengthIsThatOfTheChainAtRest) {
  const Model fish = table1_hagfish();
  const std::vector<SplineSegment> segments =
      spline(fish, kinematics(fish, rest_state(fish)).centre);
  for (int i = 0; i < 99; ++i) {
    for (const double t : {0.0, 0.3, 1.0}) {
      // At rest the animal lies along X from the origin; bodies of one length give an even spline.
      EXPECT_NEAR(segments[i].arc(t), segments[i].point(t).x(), 1e-12);
    }
  }
}

TEST(Spline, ArcLengthOfUnevenBodiesRunsFromCentreToCentre) {
  Random random(57);
  const Model model = random_chain(random, 9);
  const Kinematics kin = kinematics(model, rest_state(model));
  const std::vector<SplineSegment> segments = spline(model, kin.centre);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(segments[i].arc(0), kin.centre(0, i), rounding);
    EXPECT_NEAR(segments[i].arc(1), kin.centre(0, i + 1), rounding);
  }
}

}  // namespace hagfish::spline_test
