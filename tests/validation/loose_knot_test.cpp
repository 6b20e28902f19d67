// Loose open trefoils in elastic rods under tension F, without friction: the loop becomes a circle
// that carries no tension, F R² / B = 1/2 for a rod of no thickness, and the braid touches itself
// in an interval and one isolated point on each side of it (Audoly, Clauvelin, Neukirch, "Elastic
// knots", Phys. Rev. Lett. 99, 2007, and "Matched asymptotic expansions for knotted elastic rods",
// 2009). Thickness adds 1.34 ε² to the load, ε² = r / R: experiments/results/mechanics/page.md.
#include <gtest/gtest.h>

#include "experiments/mechanics/loose_knot.hpp"

namespace hagfish::loose_knot_test {

LooseKnot trefoil(double radius, double per_braid, double ratio) {
  const LooseKnot knot =
      pull_loose_knot({.crossings = 3, .radius = radius, .per_braid = per_braid, .ratio = ratio});
  EXPECT_EQ(knot.type, "3_1");
  EXPECT_TRUE(knot.at_rest);
  // Frictionless contacts do no work along the rod: F_t + B κ² / 2 is the same all along it and F
  // at the free end, whatever the thickness. 0.01: the curvature at the top is a mean over two
  // thirds of a radian, and steps leave the flicker of contacts; 0.006 was the most of 12 knots.
  EXPECT_NEAR(knot.integral, 1, 0.01);
  return knot;
}

TEST(LooseKnot, LoadOfTheThinRod) {
  const double thick = trefoil(0.02, 3, 0).load;
  const double thin = trefoil(0.005, 3, 0).load;
  // 1 %: the loop's ends are known to half of a body in some 150, and terms of higher order than
  // r / R are left.
  EXPECT_NEAR(thin - (thick - thin) / 3, 0.5, 0.005);
}

TEST(LooseKnot, TouchesInAnIntervalAndTwoPoints) {
  for (const double per_braid : {3.0, 6.0}) {
    const LooseKnot knot = trefoil(0.01, per_braid, 0);
    ASSERT_EQ(knot.touches.size(), 3U);
    // A chain spreads the force at a point over one body; the interval is 1.0 ε R long.
    EXPECT_LE(knot.touches.front().extent, 1);
    EXPECT_LE(knot.touches.back().extent, 1);
    EXPECT_NEAR(knot.touches[1].extent, per_braid, 1);
  }
}

/// The pulled end lets all twist out.
TEST(LooseKnot, LoadDoesNotDependOnTheTwistRigidity) {
  const double untwistable = trefoil(0.02, 4, 0).load;
  // 1 %: a chain of joints of both kinds bends at every second body alone.
  EXPECT_NEAR(trefoil(0.02, 4, 1).load / untwistable, 1, 0.01);
  EXPECT_NEAR(trefoil(0.02, 4, 2).load / untwistable, 1, 0.01);
}

}  // namespace hagfish::loose_knot_test
