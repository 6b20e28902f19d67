// What scene files say reaches the scene.
#include "core/input/files/scene_reader.hpp"

#include <gtest/gtest.h>

#include "tests/support/plain_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::scene_reader_test {

const std::string data = HAGFISH_DATA_DIR;

TEST(SceneReader, Table1FileIsThePapersScene) {
  const auto [scene, specimen, _] = read_scene(data + "/table1.toml");
  EXPECT_EQ(scene.specimen, "specimens/pacific_hagfish.toml");
  EXPECT_EQ(specimen.length, 42.4);
  EXPECT_TRUE(scene.clamp_head);
  EXPECT_EQ(scene.gravity, Eigen::Vector3d::Zero());
  EXPECT_EQ(scene.model.bodies, 100);
  EXPECT_EQ(scene.model.bending_stiffness, 500 * 0.848);
  EXPECT_EQ(scene.model.bending_damping, 0);
  // Four digits of 4 and 1 g/s per body of 0.424 cm.
  EXPECT_NEAR(scene.drag.normal, 4 / 0.424, 5e-4);
  EXPECT_NEAR(scene.drag.tangential, 1 / 0.424, 5e-4);
  EXPECT_EQ(scene.script.kind, ScriptSettings::Kind::force);
  ASSERT_EQ(scene.script.waypoints.size(), 12u);
  EXPECT_EQ(scene.script.waypoints[0].value, Eigen::Vector3d(564, -230, -31));
  EXPECT_EQ(scene.script.waypoints[11].time, 11);
  EXPECT_EQ(scene.script.waypoints[11].value, Eigen::Vector3d(-17, 16, 147));
  EXPECT_EQ(scene.controller.tighten_head.b, 0);
  EXPECT_EQ(scene.controller.tighten_tail.a, 0.5);
  EXPECT_EQ(scene.controller.tighten_tail.b, 2);
  EXPECT_EQ(scene.controller.slide_head.a, 2);
  EXPECT_EQ(scene.controller.slide_tail.b, 2);
  EXPECT_EQ(scene.time.step, 0.005);
}

TEST(SceneReader, WaypointFileIsInBodyLengths) {
  const auto [scene, specimen, _] = read_scene(data + "/overhand_waypoints.toml");
  EXPECT_EQ(scene.script.kind, ScriptSettings::Kind::position);
  EXPECT_EQ(scene.script.spring, 3000);
  EXPECT_EQ(scene.script.damper, 60);
  EXPECT_EQ(scene.script.largest_force, 1200);
  ASSERT_EQ(scene.script.waypoints.size(), 14u);
  EXPECT_EQ(scene.script.waypoints[2].time, 2);
  EXPECT_EQ(scene.script.waypoints[2].value, Eigen::Vector3d(0.849, 0.283, 0) * 42.4);
}

TEST(SceneReader, LengthsMayBeSharesOfTheBodyOrDiameters) {
  // Of 40 cm; 5 and 4 cm around at a fifth from either end, linear between: 4.5 in the mean.
  const auto [scene, specimen, _] = read_scene_text(
      "[controller]\ntail_through = \"0.25 L\"\ntight_span = \"12 D\"\nrelease_at = 2\n"
      "[contact]\nleast_arc = \"1.5 D\"\n" +
          plain_scene,
      "s", {"wall.neck=0.1 L"});
  EXPECT_EQ(scene.controller.tail_through, 10);
  EXPECT_NEAR(scene.controller.tight_span, 12 * 4.5 / 3.14159265358979, 1e-12);
  EXPECT_NEAR(scene.contact.least_arc, 1.5 * 4.5 / 3.14159265358979, 1e-13);
  EXPECT_EQ(scene.controller.release_at, 2);
  EXPECT_EQ(scene.wall.neck, 4);
}

TEST(SceneReader, TellsLengthsThatAreNone) {
  const std::string wanted =
      "must be a number of cm, or as \"0.2 L\" or \"12 D\", of body lengths or mean diameters";
  for (const char* text : {"\"L\"", "\"0.2\"", "\"0.2 M\"", "\"0.2 L long\"", "\"\""}) {
    const std::string complaint =
        scene_complaint("[controller]\ntail_through = " + std::string(text) + "\n");
    EXPECT_NE(complaint.find(wanted), std::string::npos) << complaint;
  }
  EXPECT_EQ(scene_complaint("[controller]\ntight_span = \"-1 L\"\n"),
            "s.toml:2: controller.tight_span = \"-1 L\": must be positive");
}

TEST(SceneReader, SpecimenFileIsWhereTheOptionSays) {
  const TemporaryFolder folder;
  folder.write("animal.toml", plain_specimen);
  const auto changed = read_scene_text("specimen = 'table1.toml'\n", "built in",
                                       {"specimen=" + (folder / "animal.toml").string()});
  EXPECT_EQ(changed.specimen.length, 40);
}

TEST(SceneReader, FilesThatATextNamesMayBeTextsToo) {
  const std::string scene = "specimen = 'mine.toml'\n";
  const ResolvedScene resolved =
      read_scene_text(scene, "s", {"specimen.mass=70"}, {{"mine.toml", plain_specimen}});
  EXPECT_EQ(resolved.specimen.name, "test");
  EXPECT_EQ(resolved.specimen.mass, 70);
  EXPECT_NE(error_of([&] {
              read_scene_text(scene, "s", {}, {{"other.toml", plain_specimen}});
            }).find("no such built-in file"),
            std::string::npos);
}

}  // namespace hagfish::scene_reader_test
