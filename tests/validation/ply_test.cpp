// A twisted rod under tension that has wound up a loop of itself: its pull and moment are known
// functions of the angle of its strands (experiments/mechanics/mechanics.hpp).
#include <gtest/gtest.h>

#include "experiments/mechanics/mechanics.hpp"

namespace hagfish::ply_test {

TEST(Ply, PullAndMomentAreThoseOfItsAngle) {
  const Ply ply = wind_up({.angle = 0.35, .per_radius = 2});
  // 2 %: -0.4 and -0.1 % were measured, and 1.1 and 0.6 % with half as many bodies; F goes with
  // about the fourth power of the angle, of which contacts that take turns leave some thousandths.
  EXPECT_NEAR(ply.force, 1, 0.02);
  EXPECT_NEAR(ply.moment, 1, 0.02);
  EXPECT_NEAR(ply.radius, 1, 0.002);  // the strands touch
}

}  // namespace hagfish::ply_test
