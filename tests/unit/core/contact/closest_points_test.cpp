#include "core/contact/closest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish::closest_points_test {

/// Least gap by sampling: a grid of `cells` squared, then windows around the best sample that
/// shrink fivefold, twelve times: to 1e-10 of the parameter.
double sampled_gap(const SplineSegment& a, const SplineSegment& b, int cells) {
  double centre_a = 0.5;
  double centre_b = 0.5;
  double half = 0.5;
  double best = std::numeric_limits<double>::infinity();
  std::vector<std::pair<Eigen::Vector3d, double>> points(cells + 1);
  std::vector<double> places(cells + 1);
  for (int round = 0; round < 13; ++round) {
    const int n = round == 0 ? cells : 10;
    for (int j = 0; j <= n; ++j) {
      places[j] = std::clamp(centre_b + half * (2.0 * j / n - 1), 0.0, 1.0);
      points[j] = {b.point(places[j]), b.radius(places[j])};
    }
    double best_a = centre_a;
    double best_b = centre_b;
    for (int i = 0; i <= n; ++i) {
      const double t = std::clamp(centre_a + half * (2.0 * i / n - 1), 0.0, 1.0);
      const Eigen::Vector3d x = a.point(t);
      const double r = a.radius(t);
      for (int j = 0; j <= n; ++j) {
        const double gap = (points[j].first - x).norm() - r - points[j].second;
        if (gap < best) {
          best = gap;
          best_a = t;
          best_b = places[j];
        }
      }
    }
    centre_a = best_a;
    centre_b = best_b;
    half = round == 0 ? 1.0 / cells : half / 5;
  }
  return best;
}

using Pair = std::pair<SplineSegment, SplineSegment>;

/// A strand of five hagfish bodies about its middle, turned at random. Skins of diameter 1.4 to 1.8
/// cm cannot bend more sharply than they are thick: at most 55 degrees per universal joint.
SplineSegment body_segment(Random& random, const Eigen::Vector3d& middle, bool tapered) {
  Model strand;
  // Table 1's taper is 1.3 cm of circumference on 8.48 cm of body: 0.0103 cm of radius a body.
  const double taper = tapered ? uniform(random, -0.0103, 0.0103) : 0;
  for (int b = 0; b < 6; ++b) {
    Body body;
    body.length = 0.424;
    body.radius = 0.8 + (b - 2.5) * taper;
    append_body(strand, body,
                b == 0       ? std::vector<Axis>{}
                : b % 2 == 1 ? std::vector<Axis>{Axis::y, Axis::z}
                             : std::vector<Axis>{Axis::x});
  }
  const State state = random_state(random, strand, 0.7);
  Eigen::Matrix3Xd centre = kinematics(strand, state).centre;
  const int segment = 1 + static_cast<int>(random() % 3);
  centre.colwise() += middle - 0.5 * (centre.col(segment) + centre.col(segment + 1));
  return spline(strand, centre)[segment];
}

/// Two strands of a knot: between a penetration of 0.6 cm and a gap of 1 cm.
Pair body_pair(Random& random, bool tapered) {
  const Eigen::Vector3d apart =
      random_rotation(random) * Eigen::Vector3d(uniform(random, 1.2, 2.6), 0, 0);
  return {body_segment(random, Eigen::Vector3d::Zero(), tapered),
          body_segment(random, apart, tapered)};
}

/// Any four points in a cube: loops and cusps, far sharper than a body.
SplineSegment wild_segment(Random& random, bool tapered) {
  Model four;
  Eigen::Matrix3Xd centre(3, 4);
  for (int b = 0; b < 4; ++b) {
    Body body;
    body.radius = tapered ? uniform(random, 0, 0.3) : 0.1;
    append_body(four, body, {});
    centre.col(b) = random_vector(random);
  }
  return spline(four, centre)[1];
}

Pair wild_pair(Random& random, bool tapered) {
  return {wild_segment(random, tapered), wild_segment(random, tapered)};
}

struct Misses {
  int count = 0;
  double worst = 0;
};

Misses misses(const std::vector<Pair>& pairs, int cells) {
  Misses result;
  for (const auto& [a, b] : pairs) {
    const double excess = closest_points(a, b).gap - sampled_gap(a, b, cells);
    // Both ends of the comparison are good to rounding of the gap's minimum, 1e-15 and 1e-20.
    if (excess > 1e-9) {
      ++result.count;
      result.worst = std::max(result.worst, excess);
    }
  }
  return result;
}

std::vector<Pair> pairs_of(Pair (*make)(Random&, bool), unsigned seed, int count) {
  Random random(seed);
  std::vector<Pair> pairs;
  for (int k = 0; k < count; ++k) {
    pairs.push_back(make(random, k % 2 == 0));
  }
  return pairs;
}

/// Four bodies of one girth, along which a spline has one whole segment.
Model four_bodies() {
  Model four;
  for (int b = 0; b < 4; ++b) append_body(four, {0, 1, 0.25, {}}, {});
  return four;
}

TEST(ClosestPoints, OfCrossingLinesAreExact) {
  const Model four = four_bodies();
  Eigen::Matrix3Xd x(3, 4);
  Eigen::Matrix3Xd y(3, 4);
  x << -1.2, -0.2, 0.8, 1.8, 0, 0, 0, 0, 0, 0, 0, 0;
  y << 0, 0, 0, 0, -1.7, -0.7, 0.3, 1.3, 2, 2, 2, 2;
  const ClosestPoints at = closest_points(spline(four, x)[1], spline(four, y)[1]);
  EXPECT_NEAR(at.gap, 1.5, 1e-15);
  EXPECT_NEAR(at.t_a, 0.2, 1e-8);  // a quadratic minimum: square root of rounding
  EXPECT_NEAR(at.t_b, 0.7, 1e-8);
}

TEST(ClosestPoints, MayLieOnTheEnds) {
  const Model four = four_bodies();
  Eigen::Matrix3Xd x(3, 4);
  x << -1, 0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0;
  const Eigen::Matrix3Xd y = x.colwise() + Eigen::Vector3d(1.5, 2, 0);
  const ClosestPoints at = closest_points(spline(four, x)[1], spline(four, y)[1]);
  EXPECT_EQ(at.t_a, 1);
  EXPECT_EQ(at.t_b, 0);
  EXPECT_NEAR(at.gap, std::hypot(0.5, 2) - 0.5, 1e-15);
}

TEST(ClosestPoints, OfCentrelinesThatCrossAreFinite) {
  const Model four = four_bodies();
  Eigen::Matrix3Xd x(3, 4);
  x << -1, 0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0;
  Eigen::Matrix3Xd y = Eigen::Matrix3Xd::Zero(3, 4);
  y.row(1) = x.row(0);  // they cross where both segments begin, at a sample of the grid
  EXPECT_NEAR(closest_points(spline(four, x)[1], spline(four, y)[1]).gap, -0.5, 1e-15);
  // Between samples the gap is a cone, whose tip is no quadratic minimum: the search ends there
  // with a step below its tolerance for whole ones, 1e-4.
  y.row(1).array() -= 0.5;
  y.row(0).setConstant(0.5);
  EXPECT_NEAR(closest_points(spline(four, x)[1], spline(four, y)[1]).gap, -0.5, 1e-4);
}

TEST(ClosestPoints, ReportTheGapOfTheirParameters) {
  for (const auto& [a, b] : pairs_of(wild_pair, 61, 1000)) {
    const ClosestPoints at = closest_points(a, b);
    ASSERT_TRUE(at.t_a >= 0 && at.t_a <= 1 && at.t_b >= 0 && at.t_b <= 1);
    const double gap =
        (a.point(at.t_a) - b.point(at.t_b)).norm() - a.radius(at.t_a) - b.radius(at.t_b);
    EXPECT_NEAR(at.gap, gap, 1e-15);
  }
}

TEST(ClosestPoints, OfStrandsLikeTheBodyAreTheGlobalMinimum) {
  const Misses missed = misses(pairs_of(body_pair, 62, 10000), 40);
  EXPECT_EQ(missed.count, 0) << "worst by " << missed.worst << " cm";
}

TEST(ClosestPoints, FromWhereTheyWereAreAsLowAsFromSamples) {
  Random random(66);
  for (const auto& [a, b] : pairs_of(body_pair, 66, 10000)) {
    SplineSegment before = b;
    before.c0 += 0.1 * random_vector(random);
    const double gap = closest_points(a, b, closest_points(a, before)).gap;
    EXPECT_LE(gap, closest_points(a, b).gap + 1e-9);  // both to rounding
  }
}

TEST(ClosestPoints, OfManyPairsAtOnceAreThoseOfEachAlone) {
  // Lanes do not mix: to the last bit, wherever a pair stands among others and however many there
  // are.
  const std::vector<Pair> pairs = pairs_of(body_pair, 65, 203);
  std::vector<ClosestPointsQuery> queries;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ClosestPointsQuery& query = queries.emplace_back();
    query.a = &pairs[k].first;
    query.b = &pairs[k].second;
    if (k % 3 == 0) query.guess = ClosestPoints{0.3, 0.6, 0};
  }
  ClosestPointsSearch search;
  search.answer(most_samples, queries);
  for (const ClosestPointsQuery& query : queries) {
    const ClosestPoints alone = closest_points(*query.a, *query.b, query.guess);
    EXPECT_EQ(query.closest.t_a, alone.t_a);
    EXPECT_EQ(query.closest.t_b, alone.t_b);
    EXPECT_EQ(query.closest.gap, alone.gap);
  }
}

TEST(ClosestPoints, SolveEquationFiveOfThePaper) {
  // A step is taken only where it lowers the gap, so Eq. 5 is met to what a change of the gap by
  // rounding leaves: with gaps and distances of d = 2 cm, slopes of s = 0.4 cm and a rounding of
  // 4e-16 cm, s sqrt(2 d 4e-16) = 1.6e-8 cm². The gap itself is exact to rounding.
  int interior = 0;
  for (const auto& [a, b] : pairs_of(body_pair, 64, 20000)) {
    const ClosestPoints at = closest_points(a, b);
    if (a.r1 != 0 || std::min(at.t_a, at.t_b) <= 0 || std::max(at.t_a, at.t_b) >= 1) {
      continue;
    }
    ++interior;
    const Eigen::Vector3d d = b.point(at.t_b) - a.point(at.t_a);
    EXPECT_LT(std::abs(a.slope(at.t_a).dot(d)), 3e-8);
    EXPECT_LT(std::abs(b.slope(at.t_b).dot(d)), 3e-8);
  }
  EXPECT_GT(interior, 50);
}

}  // namespace hagfish::closest_points_test
