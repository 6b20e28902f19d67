// Knot types are integers, so nothing here has a tolerance: answers must be equal.
#include "core/knot/knot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/knot_curves.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish {

// Found by GoogleTest, for messages.
void PrintTo(const KnotInvariants& type, std::ostream* out) {
  *out << "(" << type.determinant << ", " << type.v2 << ")";
}

}  // namespace hagfish

namespace hagfish::knot_test {

constexpr double pi = std::numbers::pi;
constexpr KnotInvariants unknot{1, 0};

struct NamedKnot {
  std::string name;
  KnotInvariants type;
  Eigen::Matrix3Xd polygon;
};

/// Every knot of a hagfish from two constructions, each with its mirror image.
std::vector<NamedKnot> named_knots() {
  std::vector<NamedKnot> knots = {
      {"3_1", {3, 1}, torus_knot(3)},   {"3_1", {3, 1}, braid_closure({1, 1, 1}, 2)},
      {"4_1", {5, -1}, figure_eight()}, {"4_1", {5, -1}, braid_closure({1, -2, 1, -2}, 3)},
      {"5_1", {5, 3}, torus_knot(5)},   {"5_1", {5, 3}, braid_closure({1, 1, 1, 1, 1}, 2)},
      {"5_2", {7, 2}, lissajous_5_2()}, {"5_2", {7, 2}, braid_closure({1, 1, 1, 2, -1, 2}, 3)},
  };
  for (std::size_t i = 0; i < 8; ++i) {
    knots.push_back({knots[i].name, knots[i].type, mirrored(knots[i].polygon)});
  }
  return knots;
}

/// Open curve that advances along x with coordinates of up to 1 across.
Eigen::Matrix3Xd wobbly_line(int count, std::mt19937& random) {
  Eigen::Matrix3Xd points = random_polygon(count, random);
  points.row(0).setLinSpaced(0, 10);
  return points;
}

class NamedKnots : public testing::TestWithParam<NamedKnot> {
 protected:
  const KnotInvariants& type() const { return GetParam().type; }
  const Eigen::Matrix3Xd& polygon() const { return GetParam().polygon; }
  std::mt19937 random{7};
};

INSTANTIATE_TEST_SUITE_P(Hagfish, NamedKnots, testing::ValuesIn(named_knots()),
                         [](const testing::TestParamInfo<NamedKnot>& knot) {
                           return "knot_" + knot.param.name + "_" + std::to_string(knot.index);
                         });

TEST_P(NamedKnots, OpenCurveIsUnanimous) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const KnotVote vote = knot_type(opened(polygon()), {.votes = 15, .seed = seed});
    EXPECT_EQ(vote.type, type());
    // A ray from an end 30 radii away meets the knot in about one draw of 4000.
    EXPECT_EQ(vote.agreement, 1);
  }
}

TEST_P(NamedKnots, InvariantUnderRotationOrderStartAndScale) {
  const Eigen::Vector3d sight(0.3, 0.2, 0.9);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Matrix3Xd turned = random_rotation(random).toRotationMatrix() * polygon();
    EXPECT_EQ(invariants_of_closed(turned, sight), type());
    EXPECT_EQ(invariants_of_closed(turned.rowwise().reverse(), sight), type());
    const auto first = static_cast<Eigen::Index>(random() % polygon().cols());
    EXPECT_EQ(invariants_of_closed(started_at(turned, first), sight), type());
    const double scale = std::pow(10, uniform(random, -6, 6));
    const Eigen::Vector3d shift = 10 * scale * random_vector(random);
    EXPECT_EQ(invariants_of_closed((scale * turned).colwise() + shift, sight), type());
  }
}

TEST_P(NamedKnots, InvariantUnderSmallPerturbation) {
  for (int k = 0; k < 20; ++k) {
    // Strands are 0.2 apart or more, so 0.02 per coordinate cannot let one through another.
    const Eigen::Matrix3Xd noise =
        0.02 * random_polygon(static_cast<int>(polygon().cols()), random);
    EXPECT_EQ(invariants_of_closed(polygon() + noise, random_vector(random)), type());
  }
}

TEST(Knot, TorusKnotsOfAnySize) {
  // T(2, q) has determinant q and v2 (q^2 - 1) / 8. From 31 crossings on one prime does not do.
  for (const int q : {7, 9, 29, 31, 61, 119}) {
    EXPECT_EQ(invariants_of_closed(braid_closure(std::vector<int>(q, 1), 2), {0.1, 0.2, 1}),
              (KnotInvariants{q, (q * q - 1) / 8}));
  }
}

/// Closure of (s1 s2^-1)^n, whose determinant is the Lucas number L(2n) less 2.
Eigen::Matrix3Xd turks_head(int n) {
  std::vector<int> word;
  for (int k = 0; k < n; ++k) {
    word.push_back(1);
    word.push_back(-2);
  }
  return braid_closure(word, 3);
}

TEST(Knot, LargeDeterminantsAreExactOrRefused) {
  const Eigen::Vector3d sight(0.05, 0.1, 1);
  EXPECT_EQ(invariants_of_closed(turks_head(4), sight).determinant, 45);
  EXPECT_EQ(invariants_of_closed(turks_head(16), sight).determinant, 4870845);
  EXPECT_EQ(invariants_of_closed(turks_head(20), sight).determinant, 228826125);
  EXPECT_THROW(invariants_of_closed(turks_head(22), sight), std::overflow_error);
  EXPECT_THROW(invariants_of_closed(turks_head(50), sight), std::overflow_error);
  const std::vector<int> too_many(121, 1);
  EXPECT_THROW(invariants_of_closed(braid_closure(too_many, 2), sight), std::overflow_error);
}

TEST(Knot, CrossingsThatCancelDoNotCount) {
  std::vector<int> word = {1, 1, 1};
  for (int k = 0; k < 100; ++k) {
    word.push_back(1);
    word.push_back(-1);
  }
  EXPECT_EQ(invariants_of_closed(braid_closure(word, 2), {0.1, 0.2, 1}), (KnotInvariants{3, 1}));
}

TEST(Knot, RandomPolygonsLookTheSameFromEveryDirection) {
  std::mt19937 random(3);
  int knotted = 0;
  for (int k = 0; k < 600; ++k) {
    const Eigen::Matrix3Xd points = random_polygon(k < 400 ? 15 : 22, random);
    const KnotInvariants type = invariants_of_closed(points, random_vector(random));
    for (int view = 0; view < 6; ++view) {
      EXPECT_EQ(invariants_of_closed(points, random_vector(random)), type);
    }
    EXPECT_EQ(invariants_of_closed(mirrored(points), random_vector(random)), type);
    // Arf invariant: v2 modulo 2, and 0 just where the determinant is 1 or 7 modulo 8.
    const bool arf = type.v2 % 2 != 0;
    EXPECT_EQ(type.determinant % 8 == 3 || type.determinant % 8 == 5, arf);
    EXPECT_EQ(type.determinant % 2, 1);
    knotted += type == unknot ? 0 : 1;
  }
  EXPECT_GT(knotted, 100);  // or the test would say little
}

TEST(Knot, CurvesThatAdvanceAreUnknotsForEveryClosure) {
  // A curve that advances along one axis has, closed by parallel rays, one maximum along it.
  std::mt19937 random(4);
  const Eigen::Matrix3Xd straight = sample(
      100, 0, 42.4, [](double s) -> Eigen::Vector3d { return s * Eigen::Vector3d::UnitX(); });
  const Eigen::Matrix3Xd coil = sample(100, 0, 10 * pi, [](double t) {
    return Eigen::Vector3d(std::cos(t), std::sin(t), 0.05 * t);
  });
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const Eigen::Matrix3Xd& line : {straight, coil, wobbly_line(100, random)}) {
      const KnotVote vote = knot_type(line, {.votes = 15, .seed = seed});
      EXPECT_EQ(vote.type, unknot);
      EXPECT_EQ(vote.agreement, 1);
    }
  }
}

TEST(Knot, LooseEndInsideTheKnotSplitsTheVote) {
  const Eigen::Matrix3Xd loose = torus_knot(3).leftCols(76);
  const KnotVote vote = knot_type(loose, {.votes = 200, .seed = 1});
  EXPECT_LT(vote.agreement, 1);
  EXPECT_GE(vote.agreement, 0.5);  // two answers are possible here: one has half the votes
  EXPECT_TRUE(vote.type == unknot || vote.type == (KnotInvariants{3, 1}));
  const double count = vote.agreement * 200;
  EXPECT_EQ(count, std::round(count));
}

TEST(Knot, MirroredDirectionsGiveTheMirrorImageTheSameVotes) {
  const Eigen::Matrix3Xd loose = torus_knot(3).leftCols(76);
  Eigen::Matrix3Xd image = loose;
  image.row(1) *= -1;
  int others = 0;  // where the same directions split the votes otherwise
  for (unsigned seed = 0; seed < 20; ++seed) {
    const KnotVote vote = knot_type(loose, {.votes = 50, .seed = seed});
    const KnotVote same = knot_type(image, {.votes = 50, .seed = seed, .mirror = true});
    EXPECT_EQ(same.type, vote.type);
    EXPECT_EQ(same.agreement, vote.agreement);
    others += knot_type(image, {.votes = 50, .seed = seed}).agreement != vote.agreement ? 1 : 0;
  }
  EXPECT_GT(others, 0);
}

TEST(Knot, SeedDecidesTheVoteAndATieGoesToTheSimplerKnot) {
  const Eigen::Matrix3Xd loose = torus_knot(3).leftCols(76);
  int ties = 0;
  int split = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const KnotVote vote = knot_type(loose, {.votes = 2, .seed = seed});
    const KnotVote again = knot_type(loose, {.votes = 2, .seed = seed});
    EXPECT_EQ(vote.type, again.type);
    EXPECT_EQ(vote.agreement, again.agreement);
    if (vote.agreement == 0.5) {
      ++ties;
      EXPECT_EQ(vote.type, unknot);
    } else {
      split += vote.type == unknot ? 1 : 0;
    }
  }
  EXPECT_GT(ties, 10);
  EXPECT_GT(200 - ties - split, 10);  // other seeds agree on the trefoil
}

TEST(Knot, DegenerateProjectionsAreRefused) {
  Eigen::Matrix3Xd bow(3, 5);  // the fifth vertex lies above the middle of the first edge
  bow << 0, 2, 2, 0, 1,        //
      0, 0, 2, 2, 0,           //
      0, 0, 0, 1, 1;
  EXPECT_THROW(invariants_of_closed(bow, Eigen::Vector3d::UnitZ()), std::domain_error);
  EXPECT_THROW(invariants_of_closed(bow, Eigen::Vector3d::UnitX()), std::domain_error);  // an edge
  EXPECT_EQ(invariants_of_closed(bow, {0.3, 0.2, 1}), unknot);

  Eigen::Matrix3Xd eight(3, 4);  // touches itself, so every line of sight is degenerate
  eight << 0, 1, 1, 0,           //
      0, 1, 0, 1,                //
      0, 0, 0, 0;
  EXPECT_THROW(invariants_of_closed(eight, {0.3, 0.2, 1}), std::domain_error);
  EXPECT_THROW(knot_type(eight, {.votes = 3, .seed = 1}), std::domain_error);

  Eigen::Matrix3Xd star(3, 6);      // three edges through one point of the projection
  star << 1, -1, -1, 1, 0.1, -0.1,  //
      0, 0, -1, 1, 1, -1,           //
      0, 0, 1, 1, 2, 2;
  EXPECT_THROW(invariants_of_closed(star, Eigen::Vector3d::UnitZ()), std::domain_error);
}

TEST(Knot, BadInputIsRefused) {
  const Eigen::Matrix3Xd trefoil = torus_knot(3);
  Eigen::Matrix3Xd broken = trefoil;
  broken(1, 4) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d sight(0.3, 0.2, 1);
  EXPECT_THROW(invariants_of_closed(broken, sight), std::invalid_argument);
  EXPECT_THROW(knot_type(broken, {.votes = 3, .seed = 1}), std::invalid_argument);
  EXPECT_THROW(invariants_of_closed(trefoil.leftCols(2), sight), std::invalid_argument);
  EXPECT_THROW(invariants_of_closed(trefoil, Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(knot_type(trefoil.leftCols(1), {.votes = 3, .seed = 1}), std::invalid_argument);
  EXPECT_THROW(knot_type(trefoil, {.votes = 0, .seed = 1}), std::invalid_argument);
}
}  // namespace hagfish::knot_test
