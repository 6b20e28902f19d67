// Scenes that build on others: what is inherited, what replaces it, and what bad bases are told.
#include "core/input/scene_parts.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "core/input/builtin_files.hpp"
#include "tests/support/plain_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::scene_base_test {

std::string text_of(const ResolvedScene& resolved) {
  return scene_to_toml(resolved.scene, resolved.specimen);
}

std::string complaint(const std::string& file) {
  return error_of([&] { read_scene(file); });
}

TEST(SceneBase, AloneItIsTheSameScene) {
  EXPECT_EQ(text_of(read_scene_text("base = 'table1'\n", "s")),
            text_of(read_scene(std::string(HAGFISH_DATA_DIR) + "/table1.toml")));
}

TEST(SceneBase, TablesMergeKeyByKeyAndArraysReplace) {
  const TemporaryFolder folder;
  folder.write("base.toml",
               "title = 'base'\ngravity = [1, 2, 3]\n[controller]\ncap = 7\nrelease_at = 3\n"
               "slide_head = { a = 1, b = 2 }\n[script]\nkind = 'force'\n"
               "knots = [[0, 1, 1, 1], [1, 2, 2, 2], [2, 3, 3, 3]]\n" +
                   plain_scene);
  const Scene scene =
      read_scene(folder.write("s.toml",
                              "base = 'base.toml'\ntitle = 'own'\n[controller]\ncap = 8\n"
                              "slide_head = { b = 5 }\n[script]\n"
                              "knots = [[0, 4, 4, 4], [3, 5, 5, 5]]\n[drag]\nnormal = 6\n"))
          .scene;
  EXPECT_EQ(scene.title, "own");
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.controller.cap, 8);
  EXPECT_EQ(scene.controller.release_at, 3);
  EXPECT_EQ(scene.controller.slide_head.a, 1);
  EXPECT_EQ(scene.controller.slide_head.b, 5);
  EXPECT_EQ(scene.script.kind, ScriptSettings::Kind::force);
  ASSERT_EQ(scene.script.waypoints.size(), 2u);
  EXPECT_EQ(scene.script.waypoints[1].value, Eigen::Vector3d(5, 5, 5));
  EXPECT_EQ(scene.drag.normal, 6);
  EXPECT_EQ(scene.drag.tangential, DragSettings{}.tangential);
}

TEST(SceneBase, AnAngleReplacesThatOfTheOtherUnit) {
  const TemporaryFolder folder;
  folder.write("base.toml", "[guard]\nlimit_violation_rad = 0.5\n" + plain_scene);
  const std::string scene =
      folder.write("s.toml", "base = 'base.toml'\n[guard]\nlimit_violation_deg = 180\n");
  EXPECT_EQ(read_scene(scene).scene.guard.limit_violation, std::numbers::pi);
  EXPECT_EQ(read_scene(scene, {"guard.limit_violation_rad=0.25"}).scene.guard.limit_violation,
            0.25);
}

TEST(SceneBase, FilesAreRelativeToTheOneThatNamesThem) {
  const TemporaryFolder folder;
  folder.write("animals/animal.toml", plain_specimen);
  folder.write("shared/deep.toml", "specimen = '../animals/animal.toml'\ntitle = 'deep'\n");
  folder.write("shared/base.toml", "base = 'deep.toml'\n[time]\nduration = 5\n");
  const auto [scene, animal, _] = read_scene(
      folder.write("own/deep/s.toml", "base = '../../shared/base.toml'\n[time]\nstep = 0.004\n"));
  EXPECT_EQ(animal.length, 40);
  EXPECT_EQ(scene.specimen, "../animals/animal.toml");
  EXPECT_EQ(scene.title, "deep");
  EXPECT_EQ(scene.time.duration, 5);
  EXPECT_EQ(scene.time.step, 0.004);
}

TEST(SceneBase, ASpecimenOfOnesOwnReplacesTheFileOfTheBase) {
  EXPECT_EQ(read_scene_text("base = 'table1'\n" + plain_scene, "s").specimen.name, "test");
  EXPECT_EQ(read_scene_text("base = 'table1'\n", "s", {"specimen.mass=3"}).specimen.mass, 3);
}

TEST(SceneBase, OverridesComeAfterTheBase) {
  const std::string text = "base = 'table1'\n[time]\nstep = 0.004\n";
  const Scene scene =
      read_scene_text(text, "s", {"time.step=0.005", "model.bodies=50", "controller.cap=9"}).scene;
  EXPECT_EQ(scene.time.step, 0.005);
  EXPECT_EQ(scene.model.bodies, 50);
  EXPECT_EQ(scene.controller.cap, 9);
  for (const std::string key : {"base", "base.title"}) {
    EXPECT_EQ(error_of([&] { read_scene_text(text, "s", {key + "=figure_eight"}); }),
              "s: --set " + key + "=figure_eight: only a file has a base");
  }
}

TEST(SceneBase, UnknownOnesAreTold) {
  const TemporaryFolder folder;
  const auto with_base = [&](const std::string& base) {
    return folder.write("s.toml", "title = ''\nbase = " + base + "\n" + plain_scene);
  };
  const std::string scene = with_base("'tabel1'");
  EXPECT_EQ(complaint(scene),
            scene + ":2: base = 'tabel1': no such built-in scene; did you mean table1?");
  EXPECT_EQ(complaint(with_base("'presets'")),
            scene + ":2: base = 'presets': no such built-in scene; did you mean muscles?");
  EXPECT_EQ(
      complaint(with_base("'gone.toml'")),
      scene + ":2: base = 'gone.toml': " + (folder / "gone.toml").string() + ": no such file");
  EXPECT_EQ(complaint(with_base("3")), scene + ":2: base = 3: must be a string in quotes");
  // A text of no file has no folder to look in.
  EXPECT_EQ(error_of([] { read_scene_text("base = 'table1.toml'", "s"); }),
            "s:1: base = 'table1.toml': no such built-in scene; did you mean table1?");
}

TEST(SceneBase, CirclesAreTold) {
  const TemporaryFolder folder;
  const std::string own = folder.write("own.toml", "base = './own.toml'\n");
  EXPECT_EQ(complaint(own), own + ":1: base = './own.toml': a scene cannot be its own base");
  const std::string a = folder.write("a.toml", "base = 'b.toml'\n");
  const std::string b = folder.write("b.toml", "\nbase = 'a.toml'\n");
  const std::string first = folder.write("first.toml", "base = 'a.toml'\n");
  EXPECT_EQ(complaint(first),
            b + ":2: base = 'a.toml': bases form a circle: " + a + ", " + b + ", " + a);
}

TEST(SceneBase, ErrorsInItNameItsFile) {
  const TemporaryFolder folder;
  const std::string base = folder.write("base.toml", "title = ''\n[time]\nstep = 'fast'\n");
  const std::string scene = folder.write("s.toml", "base = 'base.toml'\n" + plain_scene);
  const std::string about = " (base of " + scene + "): ";
  EXPECT_EQ(complaint(scene), base + ":3" + about + "time.step = 'fast': must be a number");
  folder.write("base.toml", "[time]\nsteps = 1\n");
  EXPECT_EQ(complaint(scene),
            base + ":2" + about + "time.steps = 1: unknown key; did you mean time.step?");
  folder.write("base.toml", "[tme]\nstep = 1\n");
  EXPECT_EQ(complaint(scene), base + ":1" + about + "tme: unknown key; did you mean time?");
  folder.write("base.toml", "title = \n");
  EXPECT_EQ(complaint(scene).rfind(base + ":1: not valid TOML: ", 0), 0u) << complaint(scene);
  // The scene's own keys, in a table that the base has too.
  folder.write("base.toml", "[time]\nstep = 0.001\n");
  folder.write("s.toml", "base = 'base.toml'\n[time]\nduration = 0\n" + plain_scene);
  EXPECT_EQ(complaint(scene), scene + ":3: time.duration = 0: must be positive");
}

TEST(SceneBase, EveryBuiltInSceneIsTheSameOnDisk) {
  for (const std::string_view name : builtin_scene_names()) {
    const std::string file = std::string(name) + ".toml";
    EXPECT_EQ(text_of(read_scene_text(std::string(*builtin_file(file)), "built in")),
              text_of(read_scene(std::string(HAGFISH_DATA_DIR) + "/" + file)))
        << file;
  }
  EXPECT_FALSE(builtin_file("table2.toml"));
}

}  // namespace hagfish::scene_base_test
