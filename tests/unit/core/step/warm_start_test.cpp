#include "core/step/warm_start.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish::warm_start_test {

/// A step that leaves these multipliers, by id.
void leave(WarmStart& warm, const std::vector<std::pair<std::int64_t, double>>& multipliers) {
  warm.begin();
  for (const auto& [id, lambda] : multipliers) warm.add(id, lambda);
  warm.end();
}

TEST(WarmStart, HasNothingAtFirst) {
  const WarmStart warm;
  EXPECT_EQ(warm.size(), 0u);
  EXPECT_EQ(warm.find(0), nullptr);
  EXPECT_EQ(warm.multiplier(0), 0);
}

TEST(WarmStart, FindsRowsByIdInWhateverOrderTheyCame) {
  WarmStart warm;
  const std::int64_t large = std::int64_t{4} << 40;  // ids use the upper half as well
  leave(warm, {{7, 0.7}, {large, 4}, {-3, 0.3}, {5, -0.5}, {large + 7, 5}});
  EXPECT_EQ(warm.size(), 5u);
  EXPECT_EQ(warm.multiplier(-3), 0.3);
  EXPECT_EQ(warm.multiplier(5), -0.5);
  EXPECT_EQ(warm.multiplier(7), 0.7);
  EXPECT_EQ(warm.multiplier(large), 4);
  EXPECT_EQ(warm.multiplier(large + 7), 5);
  for (const std::int64_t none : {std::int64_t{-4}, std::int64_t{6}, large + 1, large + 8}) {
    EXPECT_EQ(warm.find(none), nullptr) << none;
    EXPECT_EQ(warm.multiplier(none), 0) << none;
  }
}

TEST(WarmStart, KeepsTheLastStepAlone) {
  WarmStart warm;
  leave(warm, {{2, 1}, {4, 3}});
  leave(warm, {{4, 5}});
  EXPECT_EQ(warm.size(), 1u);
  EXPECT_EQ(warm.multiplier(4), 5);
  EXPECT_EQ(warm.find(2), nullptr);
  leave(warm, {});
  EXPECT_EQ(warm.size(), 0u);
}

TEST(WarmStart, FollowsManyRowsOverManySteps) {
  Random random(1);
  WarmStart warm;
  std::map<std::int64_t, double> now;
  for (int step = 0; step < 50; ++step) {
    now.clear();
    while (now.size() < 40) now[random() % 100] = uniform(random, 0, 1);
    std::vector<std::pair<std::int64_t, double>> rows(now.begin(), now.end());
    for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
    leave(warm, rows);
    for (std::int64_t id = 0; id < 100; ++id) {
      ASSERT_EQ(warm.find(id) != nullptr, now.contains(id));
      if (!now.contains(id)) continue;
      EXPECT_EQ(warm.find(id)->id, id);
      EXPECT_EQ(warm.find(id)->lambda, now[id]);
    }
  }
}

}  // namespace hagfish::warm_start_test
