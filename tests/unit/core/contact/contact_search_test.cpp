// A search for contacts that keeps its candidates, against a fresh one at every step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::contact_search_test {

/// Whether one of the contacts is `wanted`, or lies next to it and is as deep: of two basins of one
/// pair of segments a search from a guess and one from samples may find either, with gaps that
/// differed by 3e-5 cm at most. A step's path may overlap by 3e-4.
bool holds(const std::vector<Contact>& contacts, const Contact& wanted) {
  return std::ranges::any_of(contacts, [&](const Contact& c) {
    return std::abs(c.segment_a - wanted.segment_a) <= 1 &&
           std::abs(c.segment_b - wanted.segment_b) <= 1 && c.gap < wanted.gap + 1e-4;
  });
}

/// What a carried search misses of the minima that there are, step by step of the tight knot.
struct Missed {
  int touching = 0;  ///< of those that overlap
  int minima = 0;    ///< that there are
};

Missed missed(double step, int steps) {
  SceneRun run = resumed(stored_state("slide"), {"time.step=" + std::to_string(step)});
  const ObservedState& now = run.sim.now;
  Missed missed;
  for (int k = 0; k < steps; ++k) {
    run.step();
    for (const Contact& c : observe(run.model, now.state, run.scene).contact.contacts) {
      ++missed.minima;
      // Beside another one and clear of touching a minimum may be seen late.
      if (c.gap < 0 && !holds(now.observation.contact.contacts, c)) ++missed.touching;
    }
  }
  return missed;
}

TEST(ContactSearch, CarriedAlongMissesNoMinimumThatTouches) {
  for (const double step : {0.002, 0.02}) {
    const Missed found = missed(step, 100);
    EXPECT_GT(found.minima, 500) << step;
    EXPECT_EQ(found.touching, 0) << step;
  }
}

TEST(ContactSearch, ListsEveryPairThatMayTouch) {
  Random random(31);
  const Model fish = table1_hagfish();
  const ContactSettings settings;
  int listed = 0;
  for (const double noise : {0.0, 0.1, 0.5}) {
    const State state = knotted_state(random, fish, 2.45, noise);
    const std::vector<SplineSegment> segments = spline(fish, kinematics(fish, state).centre);
    Candidates candidates;
    update_candidates(segments, settings, candidates);
    const int n = static_cast<int>(segments.size());
    for (int a = 0; a < n; ++a) {
      for (int b = a + 1; b < n; ++b) {
        if (segments[b].s0 - segments[a].arc(1) < settings.least_arc) continue;
        const double gap = closest_points(segments[a], segments[b]).gap;
        const int pair = find_pair(candidates, a, b);
        if (pair < 0) {
          ASSERT_GT(gap, settings.margin);
        } else {
          ASSERT_GE(gap - settings.margin, candidates.clear_until[pair] - 1e-9);
          ++listed;
        }
      }
    }
  }
  EXPECT_GT(listed, 100);
}

// Each pair that is skipped, at every step, because it has not moved far.
TEST(ContactSearch, WhatIsNotDueIsClear) {
  SceneRun run = resumed(stored_state("slide"));
  const double margin = run.scene.contact.margin;
  int skipped = 0;
  for (int k = 0; k < 40; ++k) {
    Candidates before = run.sim.search.candidates;
    run.step();
    const std::vector<SplineSegment>& segments = run.sim.now.observation.segments;
    update_candidates(segments, run.scene.contact, before);
    std::vector<int> pairs, one_by_one;
    find_pairs_to_evaluate(before, pairs);
    for (int i = 0; i < static_cast<int>(before.pairs.size()); ++i) {
      if (before.displacement_of(i) >= before.clear_until[i]) one_by_one.push_back(i);
    }
    ASSERT_EQ(pairs, one_by_one);
    for (int i = 0; i < static_cast<int>(before.pairs.size()); ++i) {
      if (std::ranges::binary_search(pairs, i)) continue;
      const auto& [a, b] = before.pairs[i];
      // Within the margin only pairs beside a minimum are skipped, until they nearly touch.
      const bool beside = before.closest[i] && before.closest[i]->gap <= margin;
      // To the tolerance of the closest points.
      ASSERT_GT(closest_points(segments[a], segments[b]).gap, (beside ? 0 : margin) - 1e-9);
      ++skipped;
    }
  }
  EXPECT_GT(skipped, 1000);
}

}  // namespace hagfish::contact_search_test
