// Planes and strands that the body stays out of: gaps against closed forms, rates against
// differences, and a search that is carried along against a fresh one.
#include "core/contact/obstacles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/contact/observation.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::obstacles_test {

Obstacle strand(const std::vector<Eigen::Vector3d>& points, double radius, bool closed = false) {
  return {"strand", Strand{points, radius, closed}};
}

Obstacle ring(const Eigen::Vector3d& centre, double radius, double thickness) {
  std::vector<Eigen::Vector3d> points;
  constexpr int count = 32;
  for (int k = 0; k < count; ++k) {
    const double turn = 2 * std::numbers::pi * k / count;
    points.emplace_back(centre + radius * Eigen::Vector3d(0, std::cos(turn), std::sin(turn)));
  }
  return strand(points, thickness, true);
}

/// The animal at rest along +X among `obstacles`.
struct Among {
  explicit Among(std::vector<Obstacle> obstacles) {
    scene.contact.margin = 1;
    model = table1_hagfish();
    model.obstacles = std::move(obstacles);
    state = rest_state(model);
  }
  Observation look() const { return observe(model, state, scene); }

  Scene scene;
  Model model;
  State state;
};

TEST(Obstacles, AnyPlaneHoldsBodiesAsSpheres) {
  const Plane plane{{0, 0, -3}, {0, 0.6, 0.8}, 20};
  const Among among({{"floor", plane}});
  const Observation seen = among.look();
  int held = 0;
  visit_plane_gaps(among.model, seen.kin, [&](const PlaneGap& at) {
    ++held;
    EXPECT_EQ(at.obstacle, 0);
    EXPECT_GE((at.body + 0.5) * 0.424, 20);
    EXPECT_NEAR(at.gap, 2.4 - among.model.bodies[at.body].radius, 1e-13);
  });
  EXPECT_EQ(held, 53);
  const Row row = plane_row({0, plane, 60, 0});
  EXPECT_EQ(row.points().direction, plane.normal);
  EXPECT_EQ(row_name(among.model, row), "floor at body 60");
}

TEST(Obstacles, APoleIsAsFarAsItsAxisLessBothRadii) {
  // Across the body, 1.7 cm above its axis; the radius there is that of no taper.
  const Among among({strand({{3, -9, 1.7}, {3, 11, 1.7}}, 0.5)});
  const Observation seen = among.look();
  ASSERT_EQ(seen.contact.on_obstacles.size(), 1U);
  const Contact& c = seen.contact.on_obstacles[0];
  EXPECT_EQ(c.obstacle, 0);
  EXPECT_NEAR(c.gap, 1.7 - 0.5 - among.model.bodies[6].radius, 1e-9);
  EXPECT_NEAR(c.arc_a, 3, 1e-6);
  EXPECT_LT((c.normal + Eigen::Vector3d::UnitZ()).norm(), 1e-6);
  EXPECT_NEAR(strand_parameter(among.model, c), 9.0 / 20, 1e-6);
  EXPECT_TRUE(seen.contact.contacts.empty());
}

TEST(Obstacles, ABallIsAsFarAsItsMiddle) {
  const Among among({strand({{4, 2, 0}}, 0.9)});
  const Observation seen = among.look();
  ASSERT_GE(seen.contact.on_obstacles.size(), 1U);
  EXPECT_NEAR(seen.contact.least_gap, 2 - 0.9 - among.model.bodies[9].radius, 1e-6);
}

TEST(Obstacles, ARingIsRound) {
  // Seen from the body on its axis, at rest: as far everywhere.
  const Among among({ring({3, 0, 0}, 1.8, 0.3)});
  const Observation seen = among.look();
  EXPECT_NEAR(seen.contact.least_gap, 1.8 - 0.3 - among.model.bodies[6].radius, 1e-4);
  const std::vector<SplineSegment>& segments = seen.segments;
  const int first = strand_begin(among.model, 0);
  for (int k = 0; k < 32; ++k) {
    for (const double t : {0.0, 0.3, 0.5, 1.0}) {
      EXPECT_NEAR((segments[first + k].point(t) - Eigen::Vector3d(3, 0, 0)).norm(), 1.8, 1e-4);
    }
  }
}

TEST(Obstacles, SegmentsFollowThoseOfTheBody) {
  const Among among({strand({{0, 9, 0}, {1, 9, 0}, {2, 9, 1}}, 0.5), ring({3, 0, 0}, 1.8, 0.3),
                     strand({{4, 9, 0}}, 0.9)});
  const Observation seen = among.look();
  const std::vector<int> begins = {100, 103, 136};
  ASSERT_EQ(seen.segments.size(), 137U);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(strand_begin(among.model, k), begins[k]);
    EXPECT_EQ(seen.segments[begins[k]].obstacle, k);
    EXPECT_EQ(seen.segments[begins[k]].point(0), among.model.obstacles[k].strand()->points[0]);
  }
}

/// A bent body among a ring, a pole, a hook and a ball that it overlaps or nearly touches.
Among crowd(unsigned seed) {
  Among among({ring({20, 3, 0}, 3, 0.4), strand({{10, -9, 1.3}, {10, 11, 1.3}}, 0.5),
               strand({{30, 2, -2}, {31, 4, 0}, {30, 2, 3}}, 0.3), strand({{5, 1.2, 0}}, 0.4)});
  Random random(seed);
  among.state = random_state(random, among.model, 0.05, 1);
  among.state.q.head<7>() << 0, 0, 0, 1, 0, 0, 0;
  return among;
}

TEST(Obstacles, RowsAreTheRatesOfTheirGaps) {
  const Among among = crowd(5);
  const Observation seen = among.look();
  ASSERT_GE(seen.contact.on_obstacles.size(), 3U);
  const double eps = 1e-6;
  for (const Contact& c : seen.contact.on_obstacles) {
    const Row row = contact_row(among.model, c, nullptr);
    EXPECT_EQ(row.kind, RowKind::obstacle);
    EXPECT_EQ(row.points().b.count, 0);
    const auto gap_at = [&](double t) {
      const Kinematics kin =
          kinematics(among.model, {advance(among.state.q, among.state.qdot, t), among.state.qdot});
      std::vector<SplineSegment> segments;
      update_segments(among.model, kin.centre, segments);
      return contact_at(segments, c.segment_a, c.t_a, c.segment_b, c.t_b).gap;
    };
    const double rate = (gap_at(eps) - gap_at(-eps)) / (2 * eps);
    EXPECT_NEAR(row_velocity(row, seen.kin.velocities(), among.state.qdot), rate,
                1e-6 * std::max(1.0, std::abs(rate)));
  }
}

TEST(Obstacles, ASearchThatIsCarriedAlongFindsWhatAFreshOneDoes) {
  Among among = crowd(6);
  ContactSearch search;
  Observation seen;
  int found = 0;
  for (int k = 0; k < 200; ++k) {
    observe(among.model, among.state, among.scene, search, seen);
    const Observation fresh = among.look();
    EXPECT_NEAR(seen.contact.least_gap, fresh.contact.least_gap, 1e-6) << k;
    found += static_cast<int>(fresh.contact.on_obstacles.size());
    among.state.q = advance(among.state.q, among.state.qdot, 0.005);
  }
  EXPECT_GT(found, 100);
}

TEST(Obstacles, BruteForceFindsNothingNearer) {
  for (const unsigned seed : {7U, 8U, 9U}) {
    const Among among = crowd(seed);
    const Observation seen = among.look();
    double least = among.scene.contact.margin;
    const int own = among.model.body_count() - 1;
    for (int k = 0; k < static_cast<int>(among.model.obstacles.size()); ++k) {
      const int first = strand_begin(among.model, k);
      for (int b = first; b < first + segments_of(*among.model.obstacles[k].strand()); ++b) {
        for (int a = 0; a < own; ++a) {
          least = std::min(least, closest_points(seen.segments[a], seen.segments[b]).gap);
        }
      }
    }
    ASSERT_TRUE(seen.contact.contacts.empty());
    EXPECT_NEAR(seen.contact.least_gap, least, 1e-6);
  }
}

}  // namespace hagfish::obstacles_test
