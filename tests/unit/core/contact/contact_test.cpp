#include "core/contact/contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/step/rows/row.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::contact_test {

std::vector<SplineSegment> segments_of(const Model& model, const Eigen::VectorXd& q) {
  Kinematics kin;
  update_positions(model, q, kin);
  return spline(model, kin.centre);
}

ContactSet contacts_of(const Model& model, const Eigen::VectorXd& q,
                       const ContactSettings& settings = {}) {
  return find_contacts(segments_of(model, q), settings);
}

/// Centres of a loop that crosses itself once: a leg along X, three quarters of a circle that
/// climbs to `height`, a leg along -Y over the first. `shift` moves the bodies along the curve, in
/// bodies, and with them the crossing within its segments.
Eigen::Matrix3Xd crossing(const Model& model, double height, double shift) {
  const int n = model.body_count();
  const double spacing = model.bodies[0].length;
  const double arc = 0.4 * n * spacing;
  const double radius = arc / (1.5 * std::numbers::pi);
  Eigen::Matrix3Xd centre(3, n);
  for (int b = 0; b < n; ++b) {
    const double s = (b + shift - 0.5 * (n - 1)) * spacing + 0.5 * arc;  // 0 where the loop starts
    if (s < 0) {
      centre.col(b) << s, 0, 0;
    } else if (s < arc) {
      const double angle = s / radius;
      centre.col(b) << radius * std::sin(angle), radius * (1 - std::cos(angle)), height * s / arc;
    } else {
      centre.col(b) << -radius, radius - (s - arc), height;
    }
  }
  return centre;
}

TEST(Contact, ASingleBodyHasNone) {
  Candidates none;
  keep_ends({}, none);
  EXPECT_EQ(none.ends.point.rows(), 0);
  ContactSearch search;
  ContactSet set;
  for (int k = 0; k < 2; ++k) {  // anew, and from its last answer
    find_contacts({}, ContactSettings{}, 0, search, set);
    EXPECT_TRUE(set.contacts.empty() && set.near_pairs.empty());
  }
}

TEST(Contact, CrossingStrandsTouchOnce) {
  // Wherever the crossing lies in its segments, also on the border of two (4 pairs see it then).
  for (const int bodies : {100, 101}) {
    Model fish = table1_hagfish(bodies);
    for (Body& body : fish.bodies) body.radius = 0.85;
    for (int k = 0; k < 40; ++k) {
      const Eigen::Matrix3Xd centre = crossing(fish, 1.72, k / 40.0);
      const ContactSet set = find_contacts(spline(fish, centre), {});
      ASSERT_EQ(set.contacts.size(), 1U) << bodies << " bodies, shift " << k / 40.0;
      const Contact& c = set.contacts[0];
      // The legs are straight: the gap is exact but for rounding.
      EXPECT_NEAR(c.gap, 1.72 - 1.7, 1e-12);
      EXPECT_LT((c.normal + Eigen::Vector3d::UnitZ()).norm(), 1e-7);  // from b, above, to a
      EXPECT_LT((c.tangent_a - Eigen::Vector3d::UnitX()).norm(), 1e-12);
      EXPECT_LT((c.tangent_b + Eigen::Vector3d::UnitY()).norm(), 1e-12);
      EXPECT_EQ(set.least_gap, c.gap);
    }
  }
}

TEST(Contact, CrossingOverBodyCentresTouchesOnce) {
  // On a lattice of halves everything is exact: four pairs of segments see one and the same gap.
  Model model;
  Eigen::Matrix3Xd centre(3, 42);
  for (int b = 0; b < 42; ++b) {
    append_body(model, {1, 0.5, 0.75, {}, 0, 0}, {});
    if (b < 21) {
      centre.col(b) << 0.5 * (b - 10), 0, 0;
    } else {
      centre.col(b) << 0, 0.5 * (b - 31), 1.5625;
    }
  }
  const ContactSet set = find_contacts(spline(model, centre), {});
  ASSERT_EQ(set.contacts.size(), 1U);
  EXPECT_EQ(set.contacts[0].gap, 0.0625);
  EXPECT_EQ(set.contacts[0].body_a(), 10);
  EXPECT_EQ(set.contacts[0].body_b(), 31);
}

TEST(Contact, NearestBodyIsThatOfTheNearerHalf) {
  Contact c;
  c.segment_a = 3;
  c.segment_b = 30;
  c.t_a = 0.49;
  c.t_b = 0.51;
  EXPECT_EQ(c.body_a(), 3);
  EXPECT_EQ(c.body_b(), 31);
}

TEST(Contact, LeastGapIsTheLeastOfAllPairs) {
  // Every pair of segments far enough apart along the body, without bounding spheres.
  Random random(71);
  const Model fish = table1_hagfish();
  int touching = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const std::vector<SplineSegment> segments =
        segments_of(fish, knotted_state(random, fish, uniform(random, 1, 2.6), 0.02).q);
    const ContactSettings settings;
    double least = settings.margin;
    for (int a = 0; a < 99; ++a) {
      for (int b = a + 8; b < 99; ++b) {
        least = std::min(least, closest_points(segments[a], segments[b]).gap);
      }
    }
    const ContactSet set = find_contacts(segments, settings);
    EXPECT_EQ(set.least_gap, least);  // the same pair, the same arithmetic
    double lowest = settings.margin;
    for (const Contact& c : set.contacts) lowest = std::min(lowest, c.gap);
    EXPECT_NEAR(lowest, least, 2e-15);  // by contact_at, not in lanes: distances of 2 cm, rounded
    touching += set.contacts.empty() ? 0 : 1;
  }
  EXPECT_GE(touching, 10);
}

TEST(Contact, ContactsAreLocalMinimaOfTheGapInTheirOrder) {
  Random random(72);
  const Model fish = table1_hagfish();
  const auto gap_at = [&](const std::vector<SplineSegment>& segments, double a, double b) {
    const int i = std::clamp(static_cast<int>(a), 0, 98);
    const int j = std::clamp(static_cast<int>(b), 0, 98);
    return (segments[i].point(a - i) - segments[j].point(b - j)).norm() -
           segments[i].radius(a - i) - segments[j].radius(b - j);
  };
  int count = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const std::vector<SplineSegment> segments =
        segments_of(fish, knotted_state(random, fish, uniform(random, 1, 2.6), 0.02).q);
    std::pair<double, double> before;
    for (const Contact& c : find_contacts(segments, {}).contacts) {
      ++count;
      EXPECT_LT(before, std::pair(c.arc_a, c.arc_b));  // in order along the body
      before = {c.arc_a, c.arc_b};
      const double a = c.segment_a + c.t_a;
      const double b = c.segment_b + c.t_b;
      for (int k = 0; k < 24; ++k) {
        const double turn = 2 * std::numbers::pi * k / 24;
        // Near enough that no other minimum, across a border with its kink of the taper, is met.
        const double near_a = std::clamp(a + 1e-3 * std::cos(turn), 0.0, 99.0);
        const double near_b = std::clamp(b + 1e-3 * std::sin(turn), 0.0, 99.0);
        if (near_b - near_a < 9) continue;  // beyond the least arc the gap may well be less
        EXPECT_GE(gap_at(segments, near_a, near_b), c.gap - 1e-12);
      }
    }
  }
  EXPECT_GT(count, 20);
}

TEST(Contact, NeighboursNeverTouch) {
  // A ring of 8 bodies a turn would touch everywhere; strands within least_arc do not count.
  const Model fish = table1_hagfish();
  const State ring = bent_state(fish, 0, 2 * std::numbers::pi / (8 * 0.424));
  ContactSettings settings;
  settings.least_arc = 42.4;
  EXPECT_TRUE(contacts_of(fish, ring.q, settings).contacts.empty());
  settings.least_arc = 10;
  const ContactSet set = contacts_of(fish, ring.q, settings);
  EXPECT_FALSE(set.contacts.empty());
  for (const Contact& c : set.contacts) {
    EXPECT_GE(c.arc_b - c.arc_a, 10);
  }
}

/// Worst error of contact_rows against the gap's central difference, cm/s, and how many were seen.
struct RateError {
  double worst = 0;
  int seen = 0;
  int lost = 0;  ///< contacts that were not found again on one side
};

RateError gap_rates(Random& random, const Model& model, const State& start) {
  const double e = 1e-6;
  const Eigen::VectorXd v = random_entries(random, model.nv(), 1);
  const Kinematics kin = kinematics(model, {start.q, v});
  const std::vector<Contact> now = contacts_of(model, start.q).contacts;
  const std::vector<Contact> after = contacts_of(model, advance(start.q, v, e)).contacts;
  const std::vector<Contact> before = contacts_of(model, advance(start.q, v, -e)).contacts;
  const auto again = [](const std::vector<Contact>& set, const Contact& c) -> const Contact* {
    const auto it = std::min_element(set.begin(), set.end(), [&](const auto& x, const auto& y) {
      return std::hypot(x.arc_a - c.arc_a, x.arc_b - c.arc_b) <
             std::hypot(y.arc_a - c.arc_a, y.arc_b - c.arc_b);
    });
    const bool near =
        it != set.end() && std::hypot(it->arc_a - c.arc_a, it->arc_b - c.arc_b) < 0.01;
    return near ? &*it : nullptr;
  };
  RateError error;
  const std::vector<Row> rows = contact_rows(model, {now, {}, {}, 0}, {}, 1e-3);
  EXPECT_EQ(rows.size(), now.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Contact* next = again(after, now[i]);
    const Contact* last = again(before, now[i]);
    if (next == nullptr || last == nullptr) {
      ++error.lost;
      continue;
    }
    const double rate = (next->gap - last->gap) / (2 * e);
    error.worst = std::max(
        error.worst,
        std::abs(row_velocity(rows[i], {body_twists(model, kin, v), kin.centre_velocity}, v) -
                 rate));
    ++error.seen;
  }
  return error;
}

// The gap has a minimum in its parameters, so its rate is that of the two points alone. Speeds are
// some 50 cm/s; e = 1e-6 gives rounding 1e-14 / 1e-6 and truncation below it. Where the minimum
// moves over the border of two segments of different taper the gap's rate has a kink, of order e.
constexpr double rate_tolerance = 1e-6;

TEST(Contact, RowIsTheRateOfTheGapHoweverTheBodyTapers) {
  Random random(74);
  RateError all;
  for (int trial = 0; trial < 80; ++trial) {
    Model fish = table1_hagfish();
    const double phase = uniform(random, 0, 10);
    for (int b = 0; trial % 2 == 1 && b < 100; ++b) {  // up to eight times the animal's taper
      fish.bodies[b].radius = 0.75 + 0.2 * std::sin(0.4 * b + phase);
    }
    const RateError error =
        gap_rates(random, fish, knotted_state(random, fish, uniform(random, 1, 2.6), 0.02));
    EXPECT_LT(error.worst, rate_tolerance) << trial;
    all.seen += error.seen;
    all.lost += error.lost;
  }
  EXPECT_GT(all.seen, 100);
  EXPECT_LE(all.lost, all.seen / 50);
}

}  // namespace hagfish::contact_test
