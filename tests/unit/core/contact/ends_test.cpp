// Where the body begins and ends to touch itself, by hand, against dense samples, and as the body
// moves.
#include "core/contact/ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/core/contact/trefoil.hpp"

namespace hagfish::ends_test {

constexpr double level = 0.05;

TouchingEnds ends_of(const std::vector<SplineSegment>& segments, double margin = 0.1) {
  Scene scene;
  scene.contact.margin = margin;
  scene.controller.contact_gap = level;
  EndPatches patches;
  return touching_ends(segments, find_contacts(segments, scene.contact).contacts, scene, patches);
}

/// Least gap of the point `t` of segment `own` to dense samples of the strand before (behind) it.
double least_gap(const std::vector<SplineSegment>& segments, int own, double t, bool before) {
  const SplineSegment& segment = segments[own];
  double least = INFINITY;
  for (int k = before ? 0 : own + 1; k < (before ? own : static_cast<int>(segments.size())); ++k) {
    const SplineSegment& other = segments[k];
    const double between = before ? segment.s0 - other.arc(1) : other.s0 - segment.arc(1);
    if (between < ContactSettings{}.least_arc * (1 - 1e-9)) continue;
    for (double there = 0; there <= 1; there += 0.005) {
      least = std::min(least, (segment.point(t) - other.point(there)).norm() - segment.radius(t) -
                                  other.radius(there));
    }
  }
  return least;
}

TEST(TouchingEnds, OfCrossingLegsAreWhereTheGapIs) {
  // From the crossing of two straight legs at right angles, a distance z apart, the gap grows as
  // sqrt(z² + u²) along either: to the tail on the leg nearer the tail, to the head on the other.
  Model fish = table1_hagfish();
  for (Body& body : fish.bodies) body.radius = 0.85;
  const double z = 1.72;
  const double u = std::sqrt(std::pow(1.7 + level, 2) - z * z);
  for (const double shift : {0.0, 0.13, 0.3}) {
    const std::vector<SplineSegment> segments = crossing_legs(fish, shift, z);
    const TouchingEnds ends = ends_of(segments);
    ASSERT_TRUE(ends.first && ends.last);
    const auto point = [&](int segment, double t) { return segments[segment].point(t); };
    EXPECT_NEAR(point(ends.first->segment_a, ends.first->t_a).x(), shift - u, 1e-9);
    EXPECT_NEAR(point(ends.first->segment_b, ends.first->t_b).y(), shift, 1e-9);
    EXPECT_NEAR(point(ends.last->segment_b, ends.last->t_b).y(), shift + u, 1e-9);
    EXPECT_NEAR(point(ends.last->segment_a, ends.last->t_a).x(), shift, 1e-9);
    EXPECT_NEAR(ends.first->gap, level, 1e-12);
    EXPECT_NEAR(ends.last->gap, level, 1e-12);
  }
}

TEST(TouchingEnds, DoNotDependOnTheMargin) {
  // A scene file has no gap above its margin; a scene made in C++ may.
  const std::vector<SplineSegment> segments = trefoil(table1_hagfish(), 2.2);
  const TouchingEnds ends = ends_of(segments), narrow = ends_of(segments, level / 2);
  ASSERT_TRUE(narrow.first && narrow.last);
  EXPECT_NEAR(narrow.first->arc_a, ends.first->arc_a, 1e-9);
  EXPECT_NEAR(narrow.last->arc_b, ends.last->arc_b, 1e-9);
}

TEST(TouchingEnds, BeyondThemNothingTouches) {
  for (const int bodies : {60, 100, 200}) {
    const Model fish = table1_hagfish(bodies);
    for (const double height : {2.2, 2.4, 2.5}) {
      const std::vector<SplineSegment> segments = trefoil(fish, height);
      const TouchingEnds ends = ends_of(segments);
      ASSERT_TRUE(ends.first && ends.last);
      EXPECT_NEAR(ends.first->gap, level, 1e-9);
      EXPECT_NEAR(ends.last->gap, level, 1e-9);
      // Samples 0.005 of a segment apart miss the least gap by the square of that.
      for (int own = 0; own < static_cast<int>(segments.size()); ++own) {
        for (double t = 0; t < 1; t += 0.1) {
          if (own + t > ends.last->segment_b + ends.last->t_b) {
            EXPECT_GT(least_gap(segments, own, t, true), level - 1e-5) << own + t;
          }
          if (own + t < ends.first->segment_a + ends.first->t_a) {
            EXPECT_GT(least_gap(segments, own, t, false), level - 1e-5) << own + t;
          }
        }
      }
    }
  }
}

/// The outermost minima of the gap hop from joint to joint as the knot tightens evenly. These ends
/// jump where one of the three crossings begins to touch, and nowhere else.
TEST(TouchingEnds, MoveAsTheBodyDoes) {
  const Model fish = table1_hagfish();
  double first = NAN, last = NAN;
  int jumps = 0;
  for (double height = 2.55; height > 2.2; height -= 0.0005) {
    const TouchingEnds ends = ends_of(trefoil(fish, height));
    ASSERT_TRUE(ends.first && ends.last);
    if (!std::isnan(first)) {
      jumps += std::abs(ends.first->arc_a - first) > 0.02 ? 1 : 0;
      jumps += std::abs(ends.last->arc_b - last) > 0.02 ? 1 : 0;
    }
    first = ends.first->arc_a;
    last = ends.last->arc_b;
  }
  EXPECT_LE(jumps, 2);
}

TEST(TouchingEnds, AreNoneWhereNothingTouchesAndTheBodysOwnWhereItTouchesToItsEnd) {
  Model fish = table1_hagfish();
  for (Body& body : fish.bodies) body.radius = 0.85;
  EXPECT_FALSE(ends_of(spline(fish, kinematics(fish, rest_state(fish)).centre)).last);
  // A leg that lies along another one, 0.02 cm off, to its very end.
  Eigen::Matrix3Xd centre(3, 100);
  for (int b = 0; b < 100; ++b) {
    if (b < 60) {
      centre.col(b) << 0.424 * b, 0, 0;
    } else {
      centre.col(b) << 0.424 * (100 - b), 0, 1.72;
    }
  }
  const TouchingEnds ends = ends_of(spline(fish, centre));
  ASSERT_TRUE(ends.last);
  EXPECT_EQ(ends.last->segment_b + ends.last->t_b, 99);
  EXPECT_NEAR(ends.last->gap, 0.02, 1e-12);
}

}  // namespace hagfish::ends_test
