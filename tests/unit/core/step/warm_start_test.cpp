#include "core/step/warm_start.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish::warm_start_test {

RowId id_of(int n) { return {.of = RowId::Of::contact, .first = n}; }

/// A step that leaves these multipliers, by id.
void leave(WarmStart& warm, const std::vector<std::pair<RowId, double>>& multipliers) {
  warm.begin();
  for (const auto& [id, lambda] : multipliers) warm.add(id, lambda);
  warm.end();
}

TEST(WarmStart, FindsRowsByIdInWhateverOrderTheyCame) {
  WarmStart warm;
  const RowId upper{.of = RowId::Of::upper, .first = 7}, cone{.of = RowId::Of::cone, .first = 7},
      second{.of = RowId::Of::cone, .first = 7, .number = 1},
      end{.of = RowId::Of::along_b, .end = KnotEnd::last};
  leave(warm, {{second, 0.7}, {end, 4}, {id_of(3), 0.3}, {upper, -0.5}, {cone, 5}});
  EXPECT_EQ(warm.size(), 5u);
  EXPECT_EQ(warm.multiplier(id_of(3)), 0.3);
  EXPECT_EQ(warm.multiplier(upper), -0.5);
  EXPECT_EQ(warm.multiplier(second), 0.7);
  EXPECT_EQ(warm.multiplier(end), 4);
  EXPECT_EQ(warm.multiplier(cone), 5);
  for (const RowId& none : {id_of(4), RowId{.of = RowId::Of::lower, .first = 7},
                            RowId{.of = RowId::Of::along_b, .end = KnotEnd::first}}) {
    EXPECT_EQ(warm.find(none), nullptr);
    EXPECT_EQ(warm.multiplier(none), 0);
  }
}

TEST(WarmStart, FollowsManyRowsOverManySteps) {
  Random random(1);
  WarmStart warm;
  std::map<RowId, double> now;
  for (int step = 0; step < 50; ++step) {
    now.clear();
    while (now.size() < 40) now[id_of(static_cast<int>(random() % 100))] = uniform(random, 0, 1);
    std::vector<std::pair<RowId, double>> rows(now.begin(), now.end());
    for (std::size_t i = rows.size(); i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
    leave(warm, rows);
    for (int k = 0; k < 100; ++k) {
      const RowId id = id_of(k);
      ASSERT_EQ(warm.find(id) != nullptr, now.contains(id));
      if (!now.contains(id)) continue;
      EXPECT_EQ(warm.find(id)->id, id);
      EXPECT_EQ(warm.find(id)->lambda, now[id]);
    }
  }
}

}  // namespace hagfish::warm_start_test
