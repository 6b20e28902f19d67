#include "core/scene/phase.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hagfish::phase_test {

TEST(Phase, HasAnOrderInTime) {
  const std::vector<Phase> order = {Phase::form,    Phase::tighten, Phase::slide, Phase::pull,
                                    Phase::reverse, Phase::release, Phase::free};
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_EQ(phase_order(order[k]), static_cast<int>(k));
    EXPECT_EQ(holds_knot(order[k]), k >= 1 && k <= 4) << phase_name(order[k]);
  }
  // Logs hold these numbers.
  EXPECT_EQ(static_cast<int>(Phase::free), 4);
  EXPECT_EQ(static_cast<int>(Phase::reverse), 5);
  EXPECT_EQ(static_cast<int>(Phase::pull), 6);
}

TEST(Phase, HasNames) {
  EXPECT_STREQ(phase_name(Phase::form), "form");
  EXPECT_STREQ(phase_name(Phase::release), "release");
  EXPECT_STREQ(phase_name(Phase::free), "free");
  EXPECT_STREQ(phase_name(Phase::pull), "pull");
}

TEST(Table, ListsEachValueOnce) {
  const auto lists = [](const std::array<PhaseEntry, 2>& table) { return lists_each_once(table); };
  EXPECT_TRUE(lists({{{Phase::tighten, "b", ""}, {Phase::form, "a", ""}}}));
  EXPECT_FALSE(lists({{{Phase::form, "a", ""}, {Phase::form, "b", ""}}}));
  EXPECT_FALSE(lists({{{Phase::form, "a", ""}, {Phase::slide, "b", ""}}}));
  EXPECT_FALSE(lists({{{Phase::tighten, "b", ""}}}));  // an initialiser too few
}

}  // namespace hagfish::phase_test
