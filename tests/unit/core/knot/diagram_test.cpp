#include "core/knot/diagram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace hagfish::diagram_test {

/// A tangle: `count` vertices of a random walk in a box, so that some tenth of all edges cross.
Eigen::Matrix3Xd tangle(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1);
  Eigen::Matrix3Xd points(3, count);
  for (double& x : points.reshaped()) x = place(random);
  return points;
}

Eigen::Vector3d some_direction(std::mt19937& random) {
  return tangle(1, random).col(0).normalized();
}

/// Crossings numbered in the order in which they are met, their signs in that order.
Diagram renumbered(const Diagram& diagram) {
  Diagram same;
  std::map<int, int> number;
  for (Passage passage : diagram.passages) {
    const auto [at, is_new] = number.try_emplace(passage.crossing, static_cast<int>(number.size()));
    if (is_new) same.sign.push_back(diagram.sign[passage.crossing]);
    passage.crossing = at->second;
    same.passages.push_back(passage);
  }
  return same;
}

TEST(Diagram, ClosuresOfAnArcHaveTheDiagramOfTheClosedPolygon) {
  std::mt19937 random(1);
  constexpr double far = 9;
  for (const int count : {2, 3, 9, 40}) {
    std::size_t crossings = 0;
    for (int k = 0; k < 10; ++k) {
      const Eigen::Matrix3Xd arc = tangle(count, random);
      const Eigen::Vector3d sight = some_direction(random);
      SeenArc seen(arc, far, sight);
      for (int closure = 0; closure < 5; ++closure) {
        const Eigen::Vector3d out = some_direction(random);
        Eigen::Matrix3Xd whole(3, count + 2);
        whole << arc, arc.col(count - 1) + far * out, arc.col(0) + far * out;
        const Diagram of_arc = renumbered(seen.closed(out));
        const Diagram of_whole = renumbered(diagram_of_closed(whole, sight));
        ASSERT_EQ(of_arc.passages.size(), of_whole.passages.size());
        EXPECT_EQ(of_arc.sign, of_whole.sign);
        crossings += of_arc.sign.size();
        for (std::size_t i = 0; i < of_arc.passages.size(); ++i) {
          EXPECT_EQ(of_arc.passages[i].edge, of_whole.passages[i].edge);
          EXPECT_EQ(of_arc.passages[i].crossing, of_whole.passages[i].crossing);
          EXPECT_EQ(of_arc.passages[i].over, of_whole.passages[i].over);
          // Lengths of 1 to 10 about two origins, over the sine of a crossing: seldom below 1e-3.
          EXPECT_NEAR(of_arc.passages[i].at, of_whole.passages[i].at, 1e-9);
        }
      }
    }
    EXPECT_EQ(crossings > 0, count > 2);  // with two points it is a parallelogram
  }
}

/// Whether the segments from a to b and from c to d cross, seen along Z.
bool cross_in_view(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  const auto side = [](const auto& p, const auto& q, const auto& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x()) > 0;
  };
  return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
}

// Edges that are clear of a whole batch of others are told apart at once: none may be missed.
TEST(Diagram, HasTheCrossingsOfEachEdgeWithEachOther) {
  std::mt19937 random(2);
  for (const int count : {3, 8, 9, 17, 64, 90}) {
    Eigen::Matrix3Xd points = tangle(count, random);
    // Along a line, so that most edges are far from each other.
    for (int k = 0; k < count; ++k) points(0, k) += 0.2 * std::abs(k - count / 2);
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < count; ++i) {
      for (int j = i + 2; j < count - (i == 0 ? 1 : 0); ++j) {
        if (cross_in_view(points.col(i), points.col(i + 1), points.col(j),
                          points.col((j + 1) % count))) {
          expected.emplace_back(i, j);
        }
      }
    }
    const Diagram diagram = diagram_of_closed(points, Eigen::Vector3d::UnitZ());
    std::map<int, std::pair<int, int>> edges;  // of each crossing, in the polygon's order
    for (const Passage& passage : diagram.passages) {
      const auto [at, is_new] = edges.try_emplace(passage.crossing, passage.edge, -1);
      if (!is_new) at->second.second = passage.edge;
    }
    std::vector<std::pair<int, int>> found;
    for (const auto& [crossing, pair] : edges) found.push_back(pair);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << count;
  }
}

TEST(Diagram, ClosuresThatCannotBeToldApartAreRefused) {
  Eigen::Matrix3Xd arc(3, 3);  // its last vertex lies behind the second one, seen along Y
  arc << 0, 2, 2,              //
      0, 0, 1,                 //
      0, 0, 1;
  SeenArc seen(arc, 9, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(seen.closed(-Eigen::Vector3d::UnitY()).generic);
  const Diagram diagram = seen.closed(Eigen::Vector3d::UnitY());  // it can still be closed
  EXPECT_TRUE(diagram.generic);
  EXPECT_TRUE(diagram.sign.empty());
}

}  // namespace hagfish::diagram_test
