// Names of knots by their invariants, and back.
#include <gtest/gtest.h>

#include "core/knot/knot.hpp"

namespace hagfish::knot_name_test {

constexpr KnotInvariants unknot{1, 0};

TEST(KnotName, TypeOfANameIsTheOneThatHasIt) {
  for (const KnotInvariants type : {unknot, KnotInvariants{3, 1}, KnotInvariants{5, -1},
                                    KnotInvariants{21, -1}, KnotInvariants{9, 2}}) {
    EXPECT_EQ(knot_called(knot_name(type)), type);
  }
  EXPECT_EQ(knot_called("5_2"), (KnotInvariants{7, 2}));
  for (const char* none :
       {"", "5_3", "trefoil", "det=9", "det=9,v2=", "det=9,v2=2 ", "det=3,v2=1"}) {
    EXPECT_FALSE(knot_called(none)) << none;
  }
}

TEST(KnotName, NameOfAnyOther) {
  EXPECT_EQ(knot_name(unknot), "0_1");
  EXPECT_EQ(knot_name({9, 2}), "det=9,v2=2");
  EXPECT_EQ(knot_name({5, 2}), "det=5,v2=2");
}

}  // namespace hagfish::knot_name_test
