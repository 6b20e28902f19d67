// What is said of scenes and specimens that are wrong: one line with file, key, value and reason.
#include <gtest/gtest.h>

#include "tests/support/plain_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::scene_errors_test {

const std::string data = HAGFISH_DATA_DIR;

std::string script(const std::string& knots) {
  return "[script]\nkind = 'force'\nknots = [\n" + knots + "]\n";
}

TEST(SceneErrors, TellsMissingAndUnreadableFiles) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of([] { read_scene("no/such.toml"); }), "no/such.toml: no such file");
  EXPECT_EQ(error_of([] { read_specimen("no/such.toml"); }), "no/such.toml: no such file");
  EXPECT_EQ(error_of([&] { read_scene(folder.path()); }),
            folder.path().string() + ": is a directory");
  EXPECT_EQ(error_of([&] { read_specimen(folder.path()); }),
            folder.path().string() + ": is a directory");
  const std::string scene = folder.write("scene.toml", "title = ''\nspecimen = 'gone.toml'\n");
  EXPECT_EQ(
      error_of([&] { read_scene(scene); }),
      scene + ":2: specimen = 'gone.toml': " + (folder / "gone.toml").string() + ": no such file");
  EXPECT_EQ(error_of([] { read_scene_text("specimen = 'gone.toml'", "s"); }),
            "s:1: specimen = 'gone.toml': no such built-in file");
  EXPECT_EQ(error_of([] { read_scene_text("", "s", {"specimen=gone.toml"}); }),
            "s: --set specimen=gone.toml: gone.toml: no such file");
  EXPECT_EQ(error_of([] { read_scene_text("title = 'x'", "s"); }),
            "s: specimen: is missing: a file name or a table");
}

TEST(SceneErrors, RefusesWhatIsNotUtf8) {
  const std::string complaint = "s.toml: is not in UTF-8, the encoding of TOML: save it as UTF-8";
  EXPECT_EQ(scene_complaint("# caf\xe9\n"), complaint);                               // Latin-1
  EXPECT_EQ(scene_complaint(std::string("t\0i\0", 4)), complaint);                    // UTF-16
  EXPECT_EQ(scene_complaint("# caf\xc3\xa9\ntitle = 3\n").substr(0, 8), "s.toml:2");  // UTF-8
}

TEST(SceneErrors, RefusesBadValues) {
  expect_refused("", "title = 3", "must be a string in quotes");
  expect_refused("model", "bodies = 1", "must be from 2 to 400");
  expect_refused("model", "bodies = 401", "must be from 2 to 400");
  expect_refused("model", "largest_limit_deg = 90", "must be above 0 and below 90 degrees");
  expect_refused("model", "bending_limit = 'ball'", "must be one of \"box\", \"cone\"");
  expect_refused("drag", "normal = nan", "must be finite");
  expect_refused("drag", "tangential = -1", "must not be negative");
  expect_refused("constraints", "baumgarte = 1.5", "must be from 0 to 1");
  expect_refused("time", "step = 0.0", "must be positive");
  expect_refused("time", "frame_interval = 0.001", "must not be less than time.step, 0.002");
  EXPECT_EQ(scene_complaint("[time]\nstep = 0.05\n"),
            "s.toml: time.frame_interval: must not be less than time.step, 0.05");
  expect_refused("time", "duration = 0.001", "must not be less than time.step, 0.002");
}

TEST(SceneErrors, RefusesStartsThatDoNotFit) {
  EXPECT_EQ(scene_complaint("[start]\nbend = [[0, 1, 2]]\n"),
            "s.toml:2: start.bend = [0, 1, 2]: row 1 must be four numbers [station, x, y, z]");
  EXPECT_EQ(
      scene_complaint("[start]\nbend = [[0.5, 0, 0, 1], [0.5, 0, 0, 0]]\n"),
      "s.toml:2: start.bend = [0.5, 0, 0, 0]: stations must rise from 0 to 1; row 2 does not");
  EXPECT_EQ(
      scene_complaint("[start]\nbend_rate = [[1.5, 0, 0, 1]]\n"),
      "s.toml:2: start.bend_rate = [1.5, 0, 0, 1]: stations must rise from 0 to 1; row 1 does "
      "not");
  EXPECT_EQ(scene_complaint("[model]\nbodies = 2\n[start]\nq = [0, 0, 0, 1, 0, 0, 0]\n"),
            "s.toml:4: start.q = [0, 0, 0, 1, 0, 0, 0]: has 7 numbers; 2 bodies need 9");
  EXPECT_EQ(scene_complaint("[model]\nbodies = 2\n[start]\nqdot = [0]\n"),
            "s.toml:4: start.qdot = [0]: has 1 numbers; 2 bodies need 8");
  EXPECT_EQ(scene_complaint("[model]\nbodies = 2\n[start]\nq = [0, 0, 0, 0, 0, 0, 0, 0, 0]\n"),
            "s.toml:4: start.q = [0, 0, 0, 0, 0, 0, 0, 0, 0]: numbers 4 to 7 are a quaternion and "
            "must not all be 0");
  expect_refused("start", "spin = [1, 0, 0]", "must be 0, since the head is clamped (clamp_head)");
  EXPECT_EQ(scene_complaint("[start]\nbend = [[0, 0, 0, 1]]\nq = [1]\n"),
            "s.toml:3: start.q = [1]: start.bend is also given; give only one");
  EXPECT_EQ(scene_complaint("[start]\nbend_rate = [[0, 0, 0, 1]]\nqdot = [1]\n"),
            "s.toml:3: start.qdot = [1]: start.bend_rate or start.spin is also given; "
            "give only one");
  expect_refused("start", "phase = 'tie'",
                 "must be one of \"form\", \"tighten\", \"slide\", \"release\", \"free\"");
}

TEST(SceneErrors, RefusesFoodThatCannotBePulled) {
  expect_refused("food", "strength = 0", "must be positive");
  expect_refused("food", "strength = -0.5", "must be positive");
  expect_refused("food", "hold = -1", "must not be negative");
  const std::string food = "[food]\nhold = 2\ncap = { from = 10, to = 20, time = 1 }\n";
  EXPECT_EQ(scene_complaint(food), "no error");
  EXPECT_EQ(scene_complaint(food + "[wall]\npresent = false\n"),
            "s.toml:2: food.hold = 2: food needs a head plate (wall.present = true) or an "
            "obstacle for the knot to press against");
  EXPECT_EQ(scene_complaint("clamp_head = false\n" + food),
            "s.toml:3: food.hold = 2: food needs a clamped head (clamp_head = true)");
  EXPECT_EQ(scene_complaint(food + "[controller]\nfree_from = 'slide'\n"),
            "s.toml:2: food.hold = 2: food needs a clamped head, but controller.free_from = "
            "\"slide\" frees it");
  EXPECT_EQ(scene_complaint(food + "[controller]\nleave_by = 'tail'\n"),
            "s.toml:2: food.hold = 2: a knot that pulls at food cannot leave by the tail "
            "(controller.leave_by)");
  EXPECT_EQ(scene_complaint("[food]\nhold = 2\n"),
            "s.toml: food.cap.from: must be positive where there is food");
  EXPECT_EQ(scene_complaint("[food]\nhold = 2\ncap = { from = 20, to = 10, time = 1 }\n"),
            "s.toml:3: food.cap.to = 10: must not be less than food.cap.from, 20");
  EXPECT_EQ(scene_complaint("[food]\ncap = { from = 20, to = 10, time = -1 }\n"),
            "s.toml:2: food.cap.time = -1: must not be negative");
}

TEST(SceneErrors, RefusesScriptsOutOfOrder) {
  EXPECT_EQ(scene_complaint(script("[0, 1, 2, 3],\n[1, 1, 2, 3],\n[1, 4, 5, 6],\n")),
            "s.toml:6: script.knots = [1, 4, 5, 6]: knot 3 must be later than the one before it");
  EXPECT_EQ(scene_complaint(script("[0.5, 1, 2, 3],\n[1, 1, 2, 3],\n")),
            "s.toml:4: script.knots = [0.5, 1, 2, 3]: knot 1 must be at time 0");
  EXPECT_EQ(scene_complaint(script("[0, 1, 2, 3],\n[1, 1, 2],\n")),
            "s.toml:5: script.knots = [1, 1, 2]: knot 2 must be four numbers [t, x, y, z]");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'force'\nknots = [[0, 1, 2, 3]]\n"),
            "s.toml:3: script.knots = [[0, 1, 2, 3]]: a script needs two knots or more");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'force'\n"),
            "s.toml: script.knots: a script needs two knots or more");
}

TEST(SceneErrors, RefusesScriptsOfTheWrongKind) {
  const std::string knots = "knots = [[0, 1, 2, 3], [1, 1, 2, 3]]\n";
  expect_refused("script", "kind = 'pull'",
                 "must be one of \"none\", \"force\", \"position\", \"curvature\"");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'force'\nunit = 'L'\n" + knots),
            "s.toml:3: script.unit = 'L': forces are in \"dyn\" or \"N\"");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'position'\nunit = 'dyn'\n" + knots),
            "s.toml:3: script.unit = 'dyn': positions are in \"L\", \"cm\" or \"m\"");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'position'\nlargest_force = 1\n" + knots),
            "s.toml: script.spring: must be positive");
  EXPECT_EQ(scene_complaint("[script]\nkind = 'position'\nspring = 1\n" + knots),
            "s.toml: script.largest_force: must be positive");
}

TEST(SpecimenReader, RefusesBadValues) {
  const auto expect = [](const std::string& key, const std::string& value, const std::string& why) {
    expect_set_refused("specimen." + key + "=" + value, why);
  };
  expect("length", "0", "must be positive");
  expect("length", "nan", "must be finite");
  expect("mass", "-80", "must be positive");
  expect("mass", "heavy", "must be a number");
  expect("circumference", "[5, 0]", "number 2 must be positive");
  expect("circumference", "[5]", "must have as many values as station, 2");
  expect("bending_limit_deg", "[20, 30, 40]", "must have as many values as station, 2");
  expect("bending_limit_deg", "[20, -30]", "number 2 must be above 0 and below 180 degrees");
  expect("bending_limit_deg", "[0, 30]", "number 1 must be above 0 and below 180 degrees");
  expect("bending_span", "41", "must not exceed the length, 40 cm");
  expect("twist_limit_deg", "-48", "must be positive");
  expect("station", "[0.8, 0.2]", "must rise; station 2 does not");
  expect("station", "[0.2, 0.2]", "must rise; station 2 does not");
  expect("station", "[0.2, 1.5]", "number 2 must be from 0 to 1");
  expect("station", "[]", "must be an array of numbers");
}

}  // namespace hagfish::scene_errors_test
