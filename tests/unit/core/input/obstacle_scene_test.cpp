// Obstacles as scenes spell them, and what is refused.
#include <gtest/gtest.h>

#include "core/chain/model.hpp"
#include "tests/support/plain_scene.hpp"

namespace hagfish::obstacle_scene_test {

std::vector<Obstacle> read_obstacles(const std::string& text) {
  return read_scene_text(text + plain_scene, "s.toml").scene.obstacles;
}

TEST(ObstacleScene, ReadsPlanesStrandsAndRings) {
  const std::vector<Obstacle> found = read_obstacles(
      "[[obstacle]]\nkind = 'plane'\nname = 'floor'\npoint = [0, 0, -9]\nnormal = [0, 0, 2]\n"
      "neck = '0.1 L'\n"
      "[[obstacle]]\nkind = 'strand'\npoints = [[1, 5, 0], ['0.5 L', 5, 1]]\nradius = 0.4\n"
      "[[obstacle]]\nkind = 'ring'\ncentre = [20, 0, 0]\naxis = [2, 0, 0]\ninner_radius = 1.5\n"
      "radius = 0.2\n");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "floor");
  EXPECT_EQ(found[0].plane()->normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(found[0].plane()->neck, 4);
  EXPECT_EQ(found[1].name, "obstacle 2");
  EXPECT_EQ(found[1].strand()->points, (std::vector<Eigen::Vector3d>{{1, 5, 0}, {20, 5, 1}}));
  EXPECT_FALSE(found[1].strand()->closed);
  EXPECT_TRUE(found[2].strand()->closed);
  for (const Eigen::Vector3d& point : found[2].strand()->points) {
    EXPECT_NEAR((point - Eigen::Vector3d(20, 0, 0)).norm(), 1.7, 1e-14);
    EXPECT_EQ(point.x(), 20);
  }
}

TEST(ObstacleScene, TheHeadPlateIsTheFirst) {
  const std::string pole =
      "[[obstacle]]\nkind = 'strand'\npoints = [[1, 5, 0], [1, 5, 1]]\nradius = 0.4\n";
  const auto names = [&](const std::string& more) {
    const ResolvedScene read = read_scene_text(pole + more + plain_scene, "s.toml");
    std::vector<std::string> all;
    for (const Obstacle& one : read.model.obstacles) all.push_back(one.name);
    return all;
  };
  EXPECT_EQ(names(""), (std::vector<std::string>{"head plate", "obstacle 1"}));
  EXPECT_EQ(names("[wall]\npresent = false\n"), (std::vector<std::string>{"obstacle 1"}));
}

TEST(ObstacleScene, AnEmptyListTakesThoseOfTheBaseAway) {
  const ResolvedScene read = read_scene_text(
      "[[obstacle]]\nkind = 'plane'\npoint = [0, 0, -9]\nnormal = [0, 0, 1]\n" + plain_scene,
      "s.toml", {"obstacle=[]"});
  EXPECT_TRUE(read.scene.obstacles.empty());
}

TEST(ObstacleScene, MirrorsTurnThemRound) {
  const std::vector<Obstacle> found = read_obstacles(
      "mirror = true\n[[obstacle]]\nkind = 'strand'\npoints = [[1, 5, 0], [1, 6, 1]]\n"
      "radius = 0.4\n[[obstacle]]\nkind = 'plane'\npoint = [0, -9, 0]\nnormal = [0, 1, 0]\n");
  EXPECT_EQ(found[0].strand()->points[1], Eigen::Vector3d(1, -6, 1));
  EXPECT_EQ(found[1].plane()->point, Eigen::Vector3d(0, 9, 0));
  EXPECT_EQ(found[1].plane()->normal, Eigen::Vector3d(0, -1, 0));
}

TEST(ObstacleScene, RefusesWhatIsNone) {
  const std::string strand = "[[obstacle]]\nkind = 'strand'\n";
  const std::string ring = "[[obstacle]]\nkind = 'ring'\ncentre = [9, 0, 0]\naxis = [1, 0, 0]\n";
  EXPECT_EQ(scene_complaint("[[obstacle]]\nradius = 1\n"), "s.toml: obstacle 1.kind: is missing");
  EXPECT_EQ(scene_complaint("[[obstacle]]\nkind = 'cone'\n"),
            "s.toml:2: obstacle 1.kind = 'cone': must be one of \"plane\", \"strand\", \"ring\"");
  EXPECT_EQ(scene_complaint(strand + "points = [[1, 5, 0]]\nradius = 0\n"),
            "s.toml:4: obstacle 1.radius = 0: must be positive");
  EXPECT_EQ(scene_complaint(strand + "radius = 1\n"), "s.toml: obstacle 1.points: is missing");
  EXPECT_EQ(scene_complaint(strand + "points = [[1, 5]]\nradius = 1\n"),
            "s.toml:3: obstacle 1.points = [1, 5]: point 1 must be three lengths [x, y, z]");
  EXPECT_EQ(scene_complaint(strand + "points = [[1, 5, 0], [1, 5, 0]]\nradius = 1\n"),
            "s.toml:1: obstacle: points: point 2 is the same as the last one");
  EXPECT_EQ(
      scene_complaint(strand + "points = [[1, 5, 0], [2, 5, 0]]\nclosed = true\nradius = 1\n"),
      "s.toml:1: obstacle: points: a closed strand needs three or more");
  EXPECT_EQ(scene_complaint(strand + "name = \"a\\u001b\"\npoints = [[1, 5, 0]]\nradius = 1\n"),
            "s.toml:1: obstacle: name must be at most 40 letters, digits, spaces, _ and -");
  EXPECT_EQ(scene_complaint(ring + "inner_radius = 0\nradius = 1\n"),
            "s.toml:5: obstacle 1.inner_radius = 0: must be positive");
  EXPECT_EQ(
      scene_complaint(ring + "inner_radius = 0.79\nradius = 1\n"),
      "s.toml:1: obstacle: inner_radius = 0.79 cm: the hole is too narrow for the body, whose "
      "radius is 0.7957747154594768 cm");
  EXPECT_EQ(
      scene_complaint("[[obstacle]]\nkind = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n"),
      "s.toml:1: obstacle: normal must not be all 0");
  EXPECT_EQ(scene_complaint("[obstacle]\nkind = 'plane'\n"),
            "s.toml:1: obstacle: must be an array of tables");
}

TEST(ObstacleScene, AHeadComesOutOfAPlane) {
  const std::string out_of = "s.toml:2: expect.out_of = 'wall': must be the name of a plane";
  const std::string expect = "[expect]\nout_of = 'wall'\n";
  EXPECT_EQ(scene_complaint(expect).find(out_of), 0U) << scene_complaint(expect);
  EXPECT_EQ(scene_complaint("[[obstacle]]\nkind = 'plane'\nname = 'wall'\npoint = [0, 0, -9]\n"
                            "normal = [0, 0, 1]\n" +
                            expect),
            "no error");
}

TEST(ObstacleScene, RefusesOneThatTheBodyStartsIn) {
  const std::string overlap = scene_complaint(
      "[[obstacle]]\nkind = 'strand'\nname = 'pole'\npoints = [[20, -5, 1], [20, 5, 1]]\n"
      "radius = 0.5\n");
  EXPECT_EQ(overlap.find("s.toml:1: obstacle: the pole overlaps body "), 0U) << overlap;
  EXPECT_NE(overlap.find(" at the start by 0."), std::string::npos) << overlap;
  EXPECT_EQ(
      scene_complaint("[[obstacle]]\nkind = 'plane'\npoint = [0, 0, -0.5]\nnormal = [0, 0, 1]\n")
          .find("s.toml:1: obstacle: the obstacle 1 overlaps body 0 at the start by 0.2"),
      0U);
}

}  // namespace hagfish::obstacle_scene_test
