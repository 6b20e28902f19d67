#include "core/run/slide.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plain_scene.hpp"

namespace hagfish::slide_test {

/// An animal of 40 cm whose girth falls linearly to the tail by a factor, or is the same all along.
Model tapering(double tail_over_head) {
  ResolvedScene resolved = read_scene_text(plain_scene, "slide.toml");
  Specimen& animal = resolved.specimen;
  animal.length = 40;
  animal.station = {0, 1};
  animal.circumference = {5, 5 * tail_over_head};
  return make_hagfish(animal, resolved.scene);
}

/// The animal bent into two unequal bumps, the first at `place` (cm of arc), its bends in the
/// direction `turn` (rad).
Eigen::VectorXd bent(const Model& model, double place, double turn = 0.3) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.nq());
  q[3] = 1;
  double arc = 0;
  for (int b = 0; b < model.body_count(); arc += model.bodies[b].length, ++b) {
    if (model.bodies[b].dofs != 2) continue;
    const auto bump = [&](double at) { return std::exp(-0.5 * std::pow((arc - at) / 1.5, 2)); };
    const double angle = 0.4 * bump(place) + 0.25 * bump(place + 7);
    q[model.bodies[b].first_dof + 1] = angle * std::cos(turn);
    q[model.bodies[b].first_dof + 2] = angle * std::sin(turn);
  }
  return q;
}

/// A slide in steps of 0.25 cm of the head end, from 14 cm; ways for each of these of the tail end
/// and of the bends.
Slide slide(const Model& model, double tail_way, double bend_way, int steps = 32) {
  SlideWatch watch(model);
  watch.see(Phase::tighten, KnotSpan{20, 34}, bent(model, 20));
  for (int k = 0; k <= steps; ++k) {
    const double head = 0.25 * k;
    watch.see(Phase::slide, KnotSpan{14 - head, 30 - tail_way * head},
              bent(model, 18 - bend_way * head));
    watch.see(Phase::slide, std::nullopt, bent(model, 18));  // where nothing touches
  }
  watch.see(Phase::release, KnotSpan{1, 2}, bent(model, 1));
  return watch.slide();
}

TEST(Slide, OfAnEvenBodyIsAsFarAtBothEndsAndInItsBends) {
  const Slide slid = slide(tapering(1), 1, 1);
  EXPECT_DOUBLE_EQ(slid.from, 14);
  EXPECT_DOUBLE_EQ(slid.leading_way, 8);
  EXPECT_DOUBLE_EQ(slid.trailing_way, 8);
  EXPECT_NEAR(slid.taper_asks, 8, 1e-9);
  EXPECT_NEAR(slid.travel, 8, 0.02);  // places are 0.1 cm apart, joints 0.8
  EXPECT_GT(slid.correlation, 0.99);
  EXPECT_NEAR(slid.share(), 1, 0.01);
  EXPECT_EQ(slide_name(slid), "slides by both ends");
}

TEST(Slide, OfAKnotThatGrowsIsNone) {
  const Slide slid = slide(tapering(1), 0, 1);
  EXPECT_EQ(slid.share(), 0);
  EXPECT_EQ(slide_name(slid), "only grows");
  EXPECT_EQ(slide_name(slide(tapering(1), 0.6, 1)), "slides and grows");
  EXPECT_LT(slide(tapering(1), -0.2, 1).share(), 0.01);
}

// Contacts may wander along a body whose bends stay where they are.
TEST(Slide, WithoutTravelOfTheBendsIsNone) {
  const Slide slid = slide(tapering(1), 1, 0);
  EXPECT_NEAR(slid.travel, 0, 1e-9);
  EXPECT_EQ(slide_name(slid), "keeps its bends in place");
}

TEST(Slide, BackwardsOrNotAtAllHasNoShare) {
  EXPECT_EQ(slide_name(slide(tapering(1), 1, 1, 0)), "does not slide");
  EXPECT_EQ(slide(tapering(1), 1, 1, 0).share(), 0);
  EXPECT_TRUE(std::isnan(SlideWatch(tapering(1)).slide().share()));
}

TEST(Slide, ThatIsTooShortOrHasAnotherShapeHasNoShare) {
  const Model model = tapering(1);
  const auto to = [&](double way, double width) {
    SlideWatch watch(model);
    watch.see(Phase::slide, KnotSpan{14, 30}, bent(model, 18));
    watch.see(Phase::slide, KnotSpan{14 - way, 30 - way}, width * bent(model, 18 - way));
    return watch.slide();
  };
  EXPECT_EQ(slide_name(to(0.99 * least_way * model.length(), 1)), "does not slide");
  EXPECT_EQ(slide_name(to(1.01 * least_way * model.length(), 1)), "slides by both ends");
  EXPECT_NEAR(to(2, 0.1).share(), 1, 0.05);
  EXPECT_EQ(to(2, 0).share(), 0);
}

// r = r0 (1 - s / 80): ∫ ds / r goes with log(80 - s), so the knot keeps (80 - tail) / (80 - head).
TEST(Slide, OfATaperingBodyAsksLessOfTheTailEnd) {
  const Slide slid = slide(tapering(0.5), 0.8, 1);
  EXPECT_NEAR(slid.taper_asks, 30 - (80 - 74 * 50.0 / 66), 1e-3);  // ds is 0.1 cm, bodies 0.4
  EXPECT_NEAR(slid.share(), std::min(6.4 / slid.taper_asks, slid.travel / 6.4), 1e-12);
}

TEST(Slide, BackToTheTailIsLedByTheTailEnd) {
  const Model model = tapering(1);
  SlideWatch watch(model);
  for (int k = 0; k <= 32; ++k) {
    const double way = 0.25 * k;
    watch.see(Phase::reverse, KnotSpan{4 + 0.9 * way, 24 + way}, bent(model, 8 + way));
  }
  EXPECT_TRUE(std::isnan(watch.slide().leading_way));
  const Slide back = watch.way_back();
  EXPECT_DOUBLE_EQ(back.from, 24);
  EXPECT_DOUBLE_EQ(back.leading_way, 8);
  EXPECT_NEAR(back.trailing_way, 7.2, 1e-12);
  EXPECT_NEAR(back.taper_asks, 8, 1e-9);
  EXPECT_NEAR(back.travel, 8, 0.02);
}

// The total bend: it does not see the axis, in which universal joints take turns.
TEST(Slide, CurvatureIsTheTotalBendOverItsLength) {
  const Model model = tapering(1);
  const Eigen::VectorXd one = curvature_along(model, bent(model, 18, 0)),
                        other = curvature_along(model, bent(model, 18, 1.5707963267948966));
  EXPECT_LT((one - other).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(one.size(), 50);
  EXPECT_NEAR(one.maxCoeff(), 0.4 / 0.8, 0.01);
}

}  // namespace hagfish::slide_test
