// Scenes that cannot be meant are refused or pointed out before they run.
#include "experiments/common/scene_sense.hpp"

#include <gtest/gtest.h>

#include "core/log/log_writer.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::scene_sense_test {

std::string refusal(const std::vector<std::string>& changes, bool force = false) {
  return error_of([&] { check_sense(stored_scene(changes), force); });
}

TEST(SceneSense, TheMeasuredAnimalIsNotOdd) {
  EXPECT_EQ(refusal({}), "no error");
  EXPECT_TRUE(odd_things(stored_scene()).empty());
}

TEST(SceneSense, DensitiesAndLengthsThatNoHagfishHas) {
  EXPECT_EQ(
      odd_things(stored_scene({"specimen.mass=160"})),
      std::vector<std::string>{"specimen: a density of 1.74 g/cm^3, but an animal has about 1; "
                               "built-in scripts may not tie it"});
  EXPECT_EQ(odd_things(stored_scene({"specimen.mass=20"})).size(), 1u);
  EXPECT_EQ(
      odd_things(stored_scene({"specimen.length=350", "specimen.mass=660"})),
      std::vector<std::string>{"specimen.length = 350 cm: the largest hagfish are 130 cm long; "
                               "built-in scripts may not tie this animal"});
  const std::string dense = refusal({"specimen.mass=80000"});
  EXPECT_TRUE(
      dense.ends_with("g/cm^3 is more than any matter has (22.6); is mass in g, and length in cm?"))
      << dense;
  EXPECT_EQ(refusal({"specimen.mass=80000"}, true), dense) << "whatever is forced";
}

TEST(SceneSense, RunsOfTooManyStepsOrBytesAskForForce) {
  const std::vector<std::string> many = {"time.step=2e-7", "time.frame_interval=0.02",
                                         "time.duration=30"};
  EXPECT_TRUE(refusal(many).starts_with(
      "time.duration = 30 s at time.step = 2e-07 s: 1.5e+08 steps and up to "))
      << refusal(many);
  EXPECT_EQ(refusal(many, true), "no error");
  const std::vector<std::string> large = {"time.step=1e-5", "time.frame_interval=1e-5",
                                          "time.duration=30"};
  EXPECT_TRUE(refusal(large).starts_with(
      "time.duration = 30 s at time.step = 1e-05 s: 3e+06 steps and up to "))
      << refusal(large);
}

}  // namespace hagfish::scene_sense_test
