// The patch of contact at an end of the knot: by symmetry, as the body moves, and as its bodies
// become more.
#include "core/contact/patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/contact/ends.hpp"
#include "tests/unit/core/contact/trefoil.hpp"

namespace hagfish::patch_test {

Scene scene_of(double side) {
  Scene scene;
  scene.controller.contact_gap = 0.05;
  scene.controller.contact_patch = side;
  return scene;
}

TouchingEnds ends_of(const std::vector<SplineSegment>& segments, const Scene& scene) {
  EndPatches patches;
  return touching_ends(segments, find_contacts(segments, scene.contact).contacts, scene, patches);
}

TEST(ContactPatch, OfCrossingLegsIsInTheirMiddleWhereItIsAllThatTouches) {
  Model fish = table1_hagfish();
  for (Body& body : fish.bodies) body.radius = 0.85;
  const std::vector<SplineSegment> segments = crossing_legs(fish, 0, 1.72);
  const Scene scene = scene_of(10);  // more than there is
  const TouchingEnds ends = ends_of(segments, scene);
  ASSERT_TRUE(ends.first && ends.last);
  for (const bool tail : {false, true}) {
    std::vector<int> near;
    std::vector<PatchPoint> patch;
    contact_patch(segments, scene, tail ? *ends.last : *ends.first, tail, near, patch);
    double sum = 0;
    Eigen::Vector3d of_a = Eigen::Vector3d::Zero(), of_b = of_a;
    for (const auto& [contact, share] : patch) {
      EXPECT_LT(contact.gap, 0.05);
      sum += share;
      of_a += share * segments[contact.segment_a].point(contact.t_a);
      of_b += share * segments[contact.segment_b].point(contact.t_b);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT((of_a - Eigen::Vector3d(0, 0, 0)).norm(), 1e-9);
    EXPECT_LT((of_b - Eigen::Vector3d(0, 0, 1.72)).norm(), 1e-9);
  }
  // A smaller one is nearer the end, and reaches no further inwards than the whole.
  const TouchingEnds small = ends_of(segments, scene_of(0.2));
  EXPECT_GT(small.head_end, small.first->arc_a);
  EXPECT_LT(small.head_end, ends.head_end - 0.05);
  EXPECT_LT(small.tail_end, small.last->arc_b);
  EXPECT_GT(small.tail_end, ends.tail_end + 0.05);
}

/// As a knot tightens, its outermost point of contact jumps where a crossing begins to touch. The
/// mean over a patch does not: it moves by less than 0.1 cm where the point moves by more than 1.
TEST(ContactPatch, MovesAsTheBodyDoesWhereItsPointJumps) {
  const Model fish = table1_hagfish();
  const Scene scene = scene_of(0.2);
  double jump = 0, move = 0;
  std::optional<TouchingEnds> before;
  for (double height = 2.5; height > 2.2; height -= 0.00005) {
    const TouchingEnds ends = ends_of(trefoil(fish, height), scene);
    ASSERT_TRUE(ends.first && ends.last);
    if (before) {
      jump = std::max({jump, std::abs(ends.first->arc_a - before->first->arc_a),
                       std::abs(ends.last->arc_b - before->last->arc_b)});
      move = std::max({move, std::abs(ends.head_end - before->head_end),
                       std::abs(ends.tail_end - before->tail_end)});
    }
    before = ends;
  }
  EXPECT_GT(jump, 1);
  EXPECT_LT(move, 0.1);
}

// Ends of the knot as means over a patch, and as the outermost points.
TEST(ContactPatch, EndsSettleAsBodiesBecomeMore) {
  std::array<std::vector<double>, 4> arcs;
  for (const int bodies : {50, 100, 200, 400}) {
    const TouchingEnds ends = ends_of(trefoil(table1_hagfish(bodies), 2.4), scene_of(0.2));
    ASSERT_TRUE(ends.first && ends.last);
    const double found[] = {ends.head_end, ends.tail_end, ends.first->arc_a, ends.last->arc_b};
    for (std::size_t k = 0; k < arcs.size(); ++k) arcs[k].push_back(found[k]);
  }
  for (const std::vector<double>& arc : arcs) {
    EXPECT_LT(std::abs(arc[2] - arc[3]), 0.5 * std::abs(arc[1] - arc[3]) + 1e-3);
    EXPECT_LT(std::abs(arc[1] - arc[3]), 0.05);
  }
}

}  // namespace hagfish::patch_test
