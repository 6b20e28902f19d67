// Muscles in scenes and specimens: what is said of those that are wrong or missing, one line each.
#include <gtest/gtest.h>

#include "core/chain/model.hpp"
#include "tests/support/plain_scene.hpp"

namespace hagfish::muscle_scene_test {

const std::string muscle =
    "[specimen.muscle]\nlongitudinal_area = [0.5, 0.4]\noblique_area = [0.2, 0.1]\nstress = 1e6\n"
    "radius_share = 0.6\noblique_angle_deg = 45\n";
const std::string present = "[muscle]\npresent = true\n";

TEST(MuscleScene, HasTheMusclesOfItsSpecimen) {
  const ResolvedScene scene = read_scene_text(present + plain_scene + muscle, "s");
  EXPECT_EQ(scene.model.muscles.size(), 4u * 50 + 2u * 49);
  EXPECT_TRUE(make_hagfish(scene.specimen, Scene{}).muscles.empty());
}

TEST(MuscleScene, RefusesWhatIsNoMuscle) {
  const std::string more = present + muscle;
  expect_set_refused("specimen.muscle.longitudinal_area=[0.5, 0]", "number 2 must be positive",
                     more);
  expect_set_refused("specimen.muscle.oblique_area=[0.5]", "must have as many values as station, 2",
                     more);
  EXPECT_EQ(scene_complaint(more, {"specimen.muscle.stress=0"}),
            "s.toml:2: muscle.present = true: the specimen's muscle.stress is 0 or missing, but "
            "must be positive");
  expect_refused("muscle", "present = true", "the specimen has no muscle.longitudinal_area");
}

TEST(MuscleScene, TheLawNeedsMusclesAndTheirTime) {
  const std::string law = "[controller]\nlaw = 'muscles'\n";
  EXPECT_EQ(scene_complaint(law + muscle),
            "s.toml: muscle.present: must be true where controller.law = \"muscles\"");
  EXPECT_EQ(scene_complaint(law + present + muscle),
            "s.toml: muscle.activation_time: must be positive where controller.law = \"muscles\"");
}

}  // namespace hagfish::muscle_scene_test
