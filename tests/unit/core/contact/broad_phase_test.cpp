#include "core/contact/broad_phase.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_chain.hpp"

namespace hagfish {
namespace {

/// Every two segments, one by one.
std::vector<NearPair> one_by_one(const std::vector<SplineSegment>& segments, double reach,
                                 double least_arc) {
  std::vector<NearPair> pairs;
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      const double apart = (segments[a].middle - segments[b].middle).norm();
      if (segments[b].s0 - segments[a].arc(1) >= least_arc &&
          apart <= segments[a].bound + segments[b].bound + reach) {
        pairs.push_back({{a, b}, apart});
      }
    }
  }
  return pairs;
}

void expect_all_found(const std::vector<SplineSegment>& segments, BroadPhase& broad_phase) {
  for (const double reach : {-0.2, 0.1, 0.6, 5.0}) {
    for (const double least_arc : {0.0, 3.4}) {
      const std::vector<NearPair> expected = one_by_one(segments, reach, least_arc);
      const std::vector<NearPair>& found = broad_phase.find(segments, reach, least_arc);
      ASSERT_EQ(found.size(), expected.size()) << segments.size() << ' ' << reach;
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].of.a, expected[k].of.a);
        EXPECT_EQ(found[k].of.b, expected[k].of.b);
        EXPECT_NEAR(found[k].apart, expected[k].apart, 1e-14);  // rounding of a few cm
      }
    }
  }
}

// Of as many segments as fill blocks, one more and one less; the storage goes from one to the next.
TEST(BroadPhase, FindsThePairsThatAreNear) {
  Random random(31);
  BroadPhase broad_phase;
  for (const int bodies : {2, 3, 8, 9, 10, 100, 400, 65}) {
    const Model fish = table1_hagfish(bodies);
    for (const double noise : {0.0, 0.1, 0.5}) {
      const State state = knotted_state(random, fish, 2.45, noise);
      expect_all_found(spline(fish, kinematics(fish, state).centre), broad_phase);
    }
  }
}

TEST(BroadPhase, FindsNoSegmentThatIsNotThereWhereNumbersOverflow) {
  const Model fish = table1_hagfish();  // 99 segments: the last block of eight is not full
  BroadPhase broad_phase;
  const Eigen::Matrix3Xd centre = 1e200 * kinematics(fish, rest_state(fish)).centre;
  const std::vector<SplineSegment> segments = spline(fish, centre);
  for (const NearPair& near : broad_phase.find(segments, 1, 0)) {
    ASSERT_LT(near.of.b, static_cast<int>(segments.size()));
  }
}

TEST(BroadPhase, FindsNothingWithoutSegments) {
  BroadPhase broad_phase;
  EXPECT_TRUE(broad_phase.find({}, 1, 0).empty());
}

}  // namespace
}  // namespace hagfish
