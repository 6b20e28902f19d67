// Curvature programs in scenes: from a CSV file or a table, with noise and mirror images, and what
// is said of those that are wrong.
#include <gtest/gtest.h>

#include "core/input/builtin_files.hpp"
#include "core/input/csv/curvature_csv.hpp"
#include "tests/support/plain_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::curvature_scene_test {

const std::string active =
    "[active]\nstiffness = 2e5\ntone_time = 0.02\nrelax_time = 1\ncapacity = 2e5\n";
const std::string table =
    "[script]\nkind = 'curvature'\n[script.curvature]\ntimes = [0, 2]\nstations = [0, 0.5, 1]\n"
    "bend_y = [1, 2, 3, 4, 5, 6]\nbend_z = [0, 0, 0, -1, -2, -3]\ntwist = [7, 7, 7, 8, 8, 8]\n";
const std::string csv =
    "time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)\n"
    "0,0,1,0,7\n0,0.5,2,0,7\n0,1,3,0,7\n2,0,4,-1,8\n2,0.5,5,-2,8\n2,1,6,-3,8\n";

void expect_program(const CurvatureProgram& program) {
  EXPECT_EQ(program.time, (std::vector<double>{0, 2}));
  EXPECT_EQ(program.station, (std::vector<double>{0, 0.5, 1}));
  ASSERT_EQ(program.value.size(), 2u);
  Eigen::Matrix3d first, second;
  first << 1, 2, 3, 0, 0, 0, 7, 7, 7;
  second << 4, 5, 6, -1, -2, -3, 8, 8, 8;
  EXPECT_EQ(program.value[0], first);
  EXPECT_EQ(program.value[1], second);
}

CurvatureProgram program_of(const std::string& text, const std::vector<std::string>& set = {}) {
  return read_scene_text(text + active + plain_scene, "s", set).scene.script.curvature;
}

TEST(CurvatureScene, ReadsATableOrAFileBesideTheScene) {
  expect_program(program_of(table));
  const TemporaryFolder folder;
  folder.write("p.csv", csv);
  const std::string scene = folder.write(
      "s.toml", "[script]\nkind = 'curvature'\nprogram = 'p.csv'\n" + active + plain_scene);
  expect_program(read_scene(scene).scene.script.curvature);
  // A scene that builds on it in another folder: the file is beside the scene that names it.
  std::filesystem::create_directory(folder / "below");
  const std::string other = folder.write("below/t.toml", "base = '../s.toml'\n");
  expect_program(read_scene(other).scene.script.curvature);
}

TEST(CurvatureScene, NoiseIsDrawnByItsSeed) {
  const auto noise = [](const std::string& seed) {
    return program_of(table, {"script.noise=0.5", "script.noise_seed=" + seed}).noise;
  };
  EXPECT_EQ(noise("3")[1], noise("3")[1]);
  EXPECT_NE(noise("3")[1], noise("4")[1]);
  EXPECT_TRUE(program_of(table).noise.empty());
  double sum = 0;
  for (const Eigen::Matrix3Xd& at : noise("3")) sum += at.squaredNorm();
  // 18 draws: a standard deviation of 0.5 is off by a third at most, two in three times.
  EXPECT_NEAR(std::sqrt(sum / 18), 0.5, 0.25);
}

TEST(CurvatureScene, BuiltInProgramsAreNoLargerThanTheirRounding) {
  for (const char* name : {"overhand", "figure_eight", "double_overhand", "three_twist"}) {
    const std::string file = std::string("programs/") + name + ".csv";
    const std::string text(*builtin_file(file));
    EXPECT_EQ(curvature_csv(read_curvature_csv(text, file)), text);
  }
}

TEST(CurvatureScene, TellsWhatIsWrong) {
  const auto complaint = [](const std::string& more, const std::vector<std::string>& set = {}) {
    return scene_complaint(more, set);
  };
  EXPECT_EQ(complaint("[script]\nkind = 'curvature'\n" + active),
            "s.toml: script.curvature: times is missing");
  expect_set_refused("script.program=p.csv", "script.curvature is also given; give only one",
                     table + active);
  EXPECT_EQ(complaint("[script]\nkind = 'curvature'\nprogram = 'gone.csv'\n" + active),
            "s.toml:3: script.program = 'gone.csv': no such built-in file");
  expect_set_refused("script.program=gone.csv", "gone.csv: no such file",
                     "[script]\nkind = 'curvature'\n" + active);
  expect_set_refused("script.curvature.times=[0, 0]", "must rise; number 2 does not",
                     table + active);
  expect_set_refused("script.curvature.times=[1, 2]", "must have two times or more, the first 0",
                     table + active);
  expect_set_refused("script.curvature.stations=[0, 0.6, 0.5]", "must rise; number 3 does not",
                     table + active);
  expect_set_refused("script.curvature.stations=[0, 2]", "number 2 must be from 0 to 1",
                     table + active);
  expect_set_refused("script.curvature.twist=[1]", "must have times x stations values, 6",
                     table + active);
  EXPECT_EQ(complaint(table),
            "s.toml: active.stiffness: must be positive where a curvature "
            "program bends the animal");
  expect_set_refused("active.stiffness=-1", "must not be negative", table + active);
  expect_set_refused("active.capacity=0",
                     "must be positive where a curvature program bends the animal", table + active);
  expect_set_refused("controller.tighten_from=3", "the curvature program ends earlier, at 2 s",
                     table + active);
  EXPECT_EQ(complaint("[model]\npassive = 'specimen'\n"),
            "s.toml:2: model.passive = 'specimen': the specimen has no passive.bending_stiffness");
}

}  // namespace hagfish::curvature_scene_test
