// Grid files: what they say, and what is refused before the first run.
#include "experiments/sweep/grid_reader.hpp"

#include <gtest/gtest.h>

#include "core/input/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::grid_reader_test {

using Texts = std::vector<std::string>;

class GridTest : public testing::Test {
 protected:
  Grid read(const std::string& text) const { return read_grid(folder.write("grid.toml", text)); }

  /// One line that names the file and holds every part.
  void expect_refused(const std::string& text, const Texts& parts) const {
    try {
      read(text);
      ADD_FAILURE() << "read: " << text;
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("grid.toml"), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      for (const std::string& part : parts) {
        EXPECT_NE(what.find(part), std::string::npos) << part << " in " << what;
      }
    }
  }

  TemporaryFolder folder;
};

TEST_F(GridTest, AxesAreMultipliedAndKeysOfOneChangeTogether) {
  const Grid grid = read(R"(
scene = "table1"
set = ["time.step=0.02", "start.noise_deg=0.1"]
seeds = 3
keep = "failed"
[[axis]]
"model.limit_scale" = [0.8, 1, 1.25]
[[axis]]
drag.normal = [5, 10.5]
"script.kind" = ["force", "none"]
)");
  EXPECT_EQ(grid.size(), 3u * 2u * 3u);
  EXPECT_EQ(grid.keep, KeptLogs::failed);
  EXPECT_EQ(grid.keys(), (Texts{"model.limit_scale", "drag.normal", "script.kind", "start.seed"}));
  const auto values = [&](std::size_t cell) { return grid.values(grid.places(cell)); };
  EXPECT_EQ(values(0), (Texts{"0.8", "5", "force", "1"}));
  EXPECT_EQ(values(1), (Texts{"0.8", "5", "force", "2"}));
  EXPECT_EQ(values(3), (Texts{"0.8", "10.5", "none", "1"}));
  EXPECT_EQ(values(17), (Texts{"1.25", "10.5", "none", "3"}));
  const ResolvedScene last = scene_at(grid, grid.places(17));
  EXPECT_EQ(last.scene.model.limit_scale, 1.25);
  EXPECT_EQ(last.scene.drag.normal, 10.5);
  EXPECT_EQ(last.scene.script.kind, ScriptSettings::Kind::none);
  EXPECT_EQ(last.scene.start.seed, 3u);
  EXPECT_EQ(last.scene.time.step, 0.02);
}

TEST_F(GridTest, RangesHaveNineDigits) {
  const Grid grid = read(R"(
scene = "table1"
[[axis]]
"drag.normal" = { from = 1, to = 100, count = 4, scale = "log" }
"drag.tangential" = { from = 0.1, to = 0.4, count = 4 }
)");
  EXPECT_EQ(grid.axes[0].values[0], (Texts{"1", "4.64158883", "21.5443469", "100"}));
  EXPECT_EQ(grid.axes[0].values[1], (Texts{"0.1", "0.2", "0.3", "0.4"}));
}

TEST_F(GridTest, AnyValueOfASceneMayChange) {
  folder.write("own.toml", "base = 'table1'\n[model]\nbodies = 50\n");
  const Grid grid = read(R"(
[[axis]]
scene = ["table1", "own.toml"]
[[axis]]
"script.knots" = [[[0, 1, 2, 3], [1, 1, 2, 3.5]], [[0, 0, 0, 0], [2, 0, 0, 0]]]
"wall.present" = [true, false]
"title" = ["one, two", "true story"]
)");
  const ResolvedScene last = scene_at(grid, grid.places(3));
  EXPECT_EQ(last.scene.model.bodies, 50);
  EXPECT_EQ(last.scene.script.waypoints[1].time, 2);
  EXPECT_FALSE(last.scene.wall.present);
  EXPECT_EQ(last.scene.title, "true story");
}

TEST_F(GridTest, TakesValuesThatReadBesideAnyOfTheOthers) {
  for (const char* axes :
       {"'time.step' = [0.01, 0.05]\n[[axis]]\n'time.frame_interval' = [0.02, 0.1]\n",
        "'time.step' = [0.05, 0.01]\n[[axis]]\n'time.frame_interval' = [0.02, 0.1]\n"}) {
    const Grid grid = read(std::string("scene = 'table1'\n[[axis]]\n") + axes);
    EXPECT_EQ(grid.size(), 4u);
    EXPECT_FALSE(grid_identity(grid).empty());
    EXPECT_EQ(scene_with(grid, 0, 0).scene.time.step, std::stod(grid.axes[0].values[0][0]));
  }
}

TEST_F(GridTest, RefusesBadGridsInOneLine) {
  const std::string scene = "scene = 'table1'\n";
  const auto axis = [&](const std::string& text) { return scene + "[[axis]]\n" + text + "\n"; };
  expect_refused(axis("'model.limit_scal' = [1]"), {"model.limit_scal=1", "did you mean"});
  expect_refused(axis("'model.limit_scale' = [1, -1]"), {"model.limit_scale=-1", "positive"});
  expect_refused(axis("'model.limit_scale' = []"), {":3", "model.limit_scale", "no value"});
  expect_refused(axis("'model.limit_scale' = 1"), {":3", "array"});
  expect_refused(axis("'model.limit_scale' = [[{ a = 1 }]]"), {":3", "a number, a text"});
  expect_refused(axis(""), {"axis", "no key"});
  expect_refused(axis("'controller.cap' = { from = 1, to = 9 }"),
                 {"controller.cap.count", "missing"});
  expect_refused(axis("'time.step' = [0.05]\n[[axis]]\n'time.frame_interval' = [0.02, 0.03]"),
                 {"time.frame_interval", "0.05"});
  expect_refused(axis("'model.bodies' = [50]\n[[axis]]\n'model.bodies' = [60]"),
                 {"model.bodies", "axis 1"});
  expect_refused(axis("'start.noise_deg' = [1]\n[[axis]]\n'start.noise_rad' = [1]"),
                 {"start.noise_rad", "start.noise_deg of axis 1"});
  expect_refused(axis("'food.cap' = [1]\n'food.cap.from' = [1]"), {"food.cap"});
  expect_refused("set = ['time.step=0.01']\n" + axis("'time.step' = [0.02]"),
                 {"time.step", "time.step is also set in set"});
  expect_refused("set = ['time.step']\n" + axis("'model.bodies' = [50]"), {":1", "KEY=VALUE"});
  expect_refused("seeds = 2\n" + axis("'start.seed' = [1]"), {"start.seed"});
  expect_refused(axis("'model.bodies' = [50]\n'time.step' = [0.01, 0.02]"),
                 {"time.step", "2 values", "model.bodies has 1"});
  expect_refused(axis("'drag.normal' = { from = 0, to = 1, count = 3, scale = 'log' }"),
                 {"from", "positive"});
  expect_refused(axis("'drag.normal' = { from = 1, to = 2, count = 1 }"), {"count", "from 2"});
  expect_refused(axis("'drag.normal' = { from = 1, count = 3 }"), {"to", "missing"});
  expect_refused(axis("'drag.normal' = { from = 1, to = 2, count = 3, steps = 4 }"),
                 {"steps", "unknown key"});
  expect_refused(axis("scene = ['table1']"), {"has a scene"});
  expect_refused(scene, {"give an axis or seeds"});
  expect_refused("seeds = 2\n", {"scene", "missing"});
  expect_refused(scene + "seeds = 2\n", {"seeds = 2", "noise"});
  expect_refused(scene + "seeds = 0\n", {"seeds", "from 1"});
  expect_refused(scene + "keep = 'some'\nseeds = 1\n", {"keep", "failed"});
  expect_refused("scene = 'table2'\nseeds = 1\n", {"table2", "table1"});
  expect_refused(scene + "seed = 1\n", {"seed", "did you mean seeds"});
  std::string large = scene;
  for (const char* key : {"drag.normal", "drag.tangential", "model.limit_scale"}) {
    large += std::string("[[axis]]\n'") + key + "' = { from = 1, to = 2, count = 10000 }\n";
  }
  expect_refused(large, {"1e+12 cells"});
  std::string many = "'drag.normal' = [";
  for (int k = 0; k <= 10000; ++k) many += "1,";
  expect_refused(axis(many + "1]"), {"drag.normal", "more than 10000"});
}

TEST_F(GridTest, IdentityIsOfWhatMakesTheRows) {
  const std::string text = "scene = 'own.toml'\n[[axis]]\n'model.bodies' = [50, 60]\n";
  folder.write("own.toml", "base = 'table1'\n");
  const std::string identity = grid_identity(read(text));
  EXPECT_EQ(identity, grid_identity(read("keep = 'all'\n" + text)));
  EXPECT_NE(identity, grid_identity(read("set = ['time.step=0.02']\n" + text)));
  folder.write("own.toml", "base = 'table1'\n[drag]\nnormal = 9\n");
  EXPECT_NE(identity, grid_identity(read(text)));
  // Also of a scene that the first cell does not have.
  const std::string two = "[[axis]]\nscene = ['table1', 'own.toml']\n";
  const std::string before = grid_identity(read(two));
  folder.write("own.toml", "base = 'table1'\n[drag]\nnormal = 8\n");
  EXPECT_NE(before, grid_identity(read(two)));
}

}  // namespace hagfish::grid_reader_test
