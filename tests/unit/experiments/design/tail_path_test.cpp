// Ways of the tail: turns go about strands where these lie, and a path that is taken again, or from
// where another try has been, leads to the same knots.
#include "experiments/design/tail_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/knot/knot.hpp"
#include "experiments/design/soft_body.hpp"
#include "experiments/design/tries.hpp"

namespace hagfish::tail_path_test {

/// Along y, of 100 bodies, from (0.2, 0, 0.1) on.
Eigen::Matrix3Xd straight_body() {
  Eigen::Matrix3Xd centre(3, 100);
  for (int k = 0; k < 100; ++k) centre.col(k) = Eigen::Vector3d(0.2, 0.01 * k, 0.1);
  return centre;
}

TailPath path_to(const Eigen::Vector3d& place) {
  TailPath path;
  path.swing = {{0, {0.995, 0, 0}}, {4.5, place}};
  return path;
}

TEST(TailPath, TurnGoesAboutTheStrandWhereItLies) {
  const Eigen::Matrix3Xd centre = straight_body();
  TailPath path = path_to({0.3, 0.5, 0.1});  // beside body 50
  int strand = 50;
  const Winding turn{
      .choice = -1, .angle = std::numbers::pi / 2, .along = 0.02, .radius = 0.08, .duration = 0.6};
  add_turn(path, turn, centre, strand);
  ASSERT_EQ(path.turns.size(), 1);
  EXPECT_DOUBLE_EQ(path.turns[0].time, 5.1);
  const Eigen::Vector3d from = path.turns[0].place - centre.col(50);
  EXPECT_NEAR(std::abs(from.z()), 0.08,
              1e-12);  // a quarter of a turn from beside to above or below
  EXPECT_NEAR(from.x(), 0, 1e-12);
  EXPECT_NEAR(from.y(), 0.02, 1e-12);
}

TEST(TailPath, StrandsOutOfReachAreNotChosen) {
  const Eigen::Matrix3Xd centre = straight_body();
  for (const double choice : {0.0, 0.3, 0.6, 1.0}) {
    TailPath path = path_to({0.3, 0.2, 0.1});
    int strand = 0;
    add_turn(path, {.choice = choice, .radius = 0.1, .duration = 0.5}, centre, strand);
    EXPECT_LT((centre.col(strand) - path.swing.back().place).norm(), 0.25);
  }
}

TEST(TailPath, OffTheBodyIsAwayFromItsMiddle) {
  const Eigen::Matrix3Xd centre = straight_body();
  TailPath path = path_to({0.5, 0.4, 0.1});
  int strand = 7;
  Winding off;
  off.off = 0.2;
  off.duration = 0.5;
  add_turn(path, off, centre, strand);
  ASSERT_EQ(path.turns.size(), 1);
  EXPECT_EQ(strand, 7);
  EXPECT_NEAR((path.turns[0].place - path.swing.back().place).norm(), 0.2, 1e-12);
  EXPECT_GT(path.turns[0].place.x(), 0.69);
  EXPECT_GT(path.turns[0].time, 5.0);  // 0.2 body lengths in half a second would be a hurry
}

TEST(TailPath, TailLeftIsWhatCanBeCutOffATrefoil) {
  // 80 bodies along an open trefoil, and 20 on from there.
  Eigen::Matrix3Xd centre(3, 100);
  for (int k = 0; k < 80; ++k) {
    const double t = 0.3 + k * (2 * std::numbers::pi - 0.5) / 79;
    centre.col(k) = Eigen::Vector3d(std::sin(t) + 2 * std::sin(2 * t),
                                    std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t));
  }
  const Eigen::Vector3d out = centre.col(79) - centre.col(78);
  for (int k = 80; k < 100; ++k) centre.col(k) = centre.col(79) + (k - 79) * out;
  const KnotInvariants trefoil{3, 1};
  ASSERT_EQ(knot_type(centre, {}).type, trefoil);
  const double left = tail_left(centre, trefoil, {});
  EXPECT_GT(left, 0.15);
  EXPECT_LT(left, 0.5);
  const auto kept = static_cast<Eigen::Index>(std::lround(100 * (1 - left)));
  EXPECT_EQ(knot_type(centre.leftCols(kept), {}).type, trefoil);
  EXPECT_NE(knot_type(centre.leftCols(kept - 4), {}).type, trefoil);
}

TEST(TailPath, PullBeginsWhereTheTailIsAndGoesOn) {
  const Eigen::Matrix3Xd centre = straight_body();
  TailPath path = path_to({0.3, 0.5, 0.1});
  path.turns = {{5, {0.3, 0.6, 0.1}}, {6, {0.3, 0.7, 0.1}}};
  Draw draw(1, 1);
  end_with_pull(path, 5.5, centre, draw);
  ASSERT_EQ(path.turns.size(), 2);
  EXPECT_EQ(path.turns.back().place, centre.col(99));
  EXPECT_DOUBLE_EQ(path_end(path), 7.5);
  const double way = (path.pull.back().place - centre.col(99)).norm();
  EXPECT_GE(way, 0.1);
  EXPECT_LE(way, 0.25);
}

TEST(TailPath, GoingOnFromWhereATryWasIsTakingItsPathAgain) {
  const SoftBody body = soft_body("");
  const auto never = [] { return false; };
  const std::string wanted = "7_7";  // nothing of the kind is tied
  // The first try that ties something and did not know more of its path by then.
  Tying first;
  const auto turns = [&] { return path_reached(first.path, first.seen[1].at).turns.size(); };
  unsigned number = 0;
  do {
    ASSERT_LT(number, 100);
    Draw draw(1, number++);
    first = *try_plan(body, random_plan(draw), wanted, draw, never);
  } while (first.seen.size() < 2 || !first.seen[1].reached ||
           first.seen[1].reached->path.turns.size() != turns());
  const TypeSeen& seen = first.seen[1];
  Draw draw(2, 2);
  PathPlan plan = further_plan(path_reached(first.path, seen.at), draw);
  const std::string again = tying_text(*try_plan(body, plan, wanted, draw, never));
  plan.reached = seen.reached;
  EXPECT_EQ(plan.path.turns.size(), seen.reached->path.turns.size());
  EXPECT_EQ(tying_text(*try_plan(body, plan, wanted, draw, never)), again);
}

}  // namespace hagfish::tail_path_test
