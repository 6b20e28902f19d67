// What a scene says about its knot: mirror image, noise on the script, what is expected.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plain_scene.hpp"

namespace hagfish::scene_knots_test {

const std::string data = HAGFISH_DATA_DIR;

// That the rest is reflected: validation/mirror_image_test.cpp.
TEST(SceneKnots, TheMirrorImageExpectsTheOtherHand) {
  const auto hand = [](const std::string& scene, const std::vector<std::string>& set = {}) {
    return read_scene(data + scene, set).scene.expect.hand;
  };
  EXPECT_EQ(hand("/double_overhand.toml"), Hand::right);
  EXPECT_EQ(hand("/double_overhand.toml", {"mirror=true"}), Hand::left);
  EXPECT_EQ(hand("/figure_eight.toml", {"mirror=true"}), Hand::any);
}

TEST(SceneKnots, NoiseIsNormalAndOneDrawPerSeed) {
  const auto noise = [](const std::string& seed) {
    std::vector<double> all;
    for (const auto& knot :
         read_scene(data + "/three_twist.toml", {"script.noise=0.2", "script.noise_seed=" + seed})
             .scene.script.waypoints) {
      all.insert(all.end(), knot.noise.begin(), knot.noise.end());
    }
    return all;
  };
  EXPECT_EQ(noise("3"), noise("3"));
  EXPECT_NE(noise("3"), noise("4"));
  double square = 0;
  double sum = 0;
  int count = 0;
  int far = 0;  // beyond one standard deviation
  for (int seed = 1; seed <= 50; ++seed) {
    for (const double x : noise(std::to_string(seed))) {
      square += x * x;
      sum += x;
      ++count;
      far += std::abs(x) > 0.2 ? 1 : 0;
    }
  }
  // Some 3000 numbers: standard errors of the mean 0.02, of the spread 0.013, of the share 0.0085,
  // of which four each.
  EXPECT_NEAR(sum / count / 0.2, 0, 0.08);
  EXPECT_NEAR(std::sqrt(square / count) / 0.2, 1, 0.052);
  EXPECT_NEAR(far / double(count), 0.3173, 0.034);
  for (const auto& knot : read_scene(data + "/three_twist.toml").scene.script.waypoints) {
    EXPECT_EQ(knot.noise, Eigen::Vector3d::Zero());
  }
}

TEST(SceneKnots, RefusesBadExpectations) {
  const std::string names = "must be the name of a knot, 3_1 to 7_7 or det=D,v2=V";
  EXPECT_EQ(scene_complaint("[expect]\nknot = '3_2'\n"),
            "s.toml:2: expect.knot = '3_2': " + names + ", or empty for none");
  EXPECT_EQ(scene_complaint("[expect]\nknot = '0_1'\n"),
            "s.toml:2: expect.knot = '0_1': " + names + ", or empty for none");
  EXPECT_EQ(scene_complaint("[expect]\nknot = 'det=9,v2=2'\n"), "no error");
  EXPECT_EQ(scene_complaint("[expect]\ntypes = [['0_1', 0, 1], ['8_1', 2, 3]]\n"),
            "s.toml:2: expect.types = ['8_1', 2, 3]: type " + names + ", or 0_1 for none");
  EXPECT_EQ(scene_complaint("[expect]\ntypes = [['0_1', 0, 2], ['3_1', 1, 3]]\n"),
            "s.toml:2: expect.types = ['3_1', 1, 3]: times must rise");
  EXPECT_EQ(scene_complaint("[expect]\ntypes = [['0_1', 2, 1]]\n"),
            "s.toml:2: expect.types = ['0_1', 2, 1]: times must rise");
  EXPECT_EQ(scene_complaint("[expect]\ntypes = [['0_1', 0]]\n"),
            "s.toml:2: expect.types = ['0_1', 0]: stretch 1 must be [type, from, to]");
  EXPECT_EQ(
      scene_complaint(
          "[expect]\ntypes = [['3_1', 'tighten', 'release'], ['0_1', 'free + 0.5', 'end']]\n"),
      "no error");
  EXPECT_EQ(scene_complaint("[expect]\ntypes = [['3_1', 'release', 'tighten']]\n"),
            "s.toml:2: expect.types = ['3_1', 'release', 'tighten']: times must rise");
  for (const std::string time :
       {"later", "release +0.5", "release + x", "release + -1", "nan", ""}) {
    EXPECT_EQ(scene_complaint("[expect]\ntypes = [['3_1', '" + time + "', 9]]\n"),
              "s.toml:2: expect.types = ['3_1', '" + time +
                  "', 9]: a time must be in s, a phase as in \"release\", later as in "
                  "\"free + 0.5\", or \"end\"");
  }
  expect_refused("expect", "hand = 'both'", "must be one of \"any\", \"right\", \"left\"");
  expect_refused("controller", "free_from = 'form'",
                 "must be one of \"tighten\", \"slide\", \"release\", \"free\"");
  expect_refused("", "mirror = 1", "must be true or false");
  expect_refused("constraints", "stride = 1e-9", "must be at least 0.001");
  expect_refused("script", "noise = -1", "must not be negative");
}

}  // namespace hagfish::scene_knots_test
