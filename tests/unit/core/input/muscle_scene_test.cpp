// Muscles in scenes and specimens: what is said of those that are wrong or missing, one line each.
#include <gtest/gtest.h>

#include "core/chain/model.hpp"
#include "tests/support/plain_scene.hpp"

namespace hagfish::muscle_scene_test {

const std::string muscle =
    "[specimen.muscle]\nlongitudinal_area = [0.5, 0.4]\noblique_area = [0.2, 0.1]\nstress = 1e6\n"
    "radius_share = 0.6\noblique_angle_deg = 45\n";
const std::string present = "[muscle]\npresent = true\n";

std::string complaint(const std::string& text, const std::vector<std::string>& set = {}) {
  return error_of([&] { read_scene_text(text, "s", set); });
}

TEST(MuscleScene, HasTheMusclesOfItsSpecimen) {
  const ResolvedScene scene = read_scene_text(present + plain_scene + muscle, "s");
  const Model model = make_hagfish(scene.specimen, scene.scene);
  EXPECT_EQ(model.muscles.size(), 4u * 50 + 2u * 49);
  EXPECT_TRUE(make_hagfish(scene.specimen, Scene{}).muscles.empty());
}

TEST(MuscleScene, RefusesWhatIsNoMuscle) {
  const std::string text = present + plain_scene + muscle;
  EXPECT_EQ(complaint(text, {"specimen.muscle.longitudinal_area=[0.5, 0]"}),
            "s: --set specimen.muscle.longitudinal_area=[0.5, 0]: number 2 must be positive");
  EXPECT_EQ(complaint(text, {"specimen.muscle.oblique_area=[0.5]"}),
            "s: --set specimen.muscle.oblique_area=[0.5]: specimen: its muscle.oblique_area must "
            "have as many values as station, 2");
  EXPECT_EQ(complaint(text, {"specimen.muscle.stress=0"}),
            "s:2: muscle.present = true: the specimen's muscle.stress is 0 or missing, but must be "
            "positive");
  EXPECT_EQ(complaint(present + plain_scene),
            "s:2: muscle.present = true: the specimen has no muscle.longitudinal_area");
}

TEST(MuscleScene, TheLawNeedsMusclesAndTheirTime) {
  const std::string law = "[controller]\nlaw = 'muscles'\n";
  EXPECT_EQ(complaint(law + plain_scene + muscle),
            "s: muscle.present: must be true where controller.law = \"muscles\"");
  EXPECT_EQ(complaint(law + present + plain_scene + muscle),
            "s: muscle.activation_time: must be positive where controller.law = \"muscles\"");
}

}  // namespace hagfish::muscle_scene_test
