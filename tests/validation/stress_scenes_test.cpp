// The scenes of experiments/studies/stability.sh: each is read, runs on for a few steps by the core
// and in MuJoCo, and ends in an outcome by name, whatever the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/input/scene_reader.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/stress/stress_judge.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

constexpr int most_bodies = 100;

std::vector<std::string> scenes() {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(HAGFISH_STRESS_DIR)) {
    found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The outcome that a cell's file tells; empty where it is none.
std::string outcome_in(const std::string& file) {
  std::ifstream in(file);
  std::string heading, row, field;
  std::getline(in, heading);
  std::getline(in, row);
  std::istringstream fields(row);
  for (int i = 0; i < 5; ++i) {
    std::getline(fields, field, ',');
  }
  for (int i = 0; i < outcome_count; ++i) {
    if (field == outcome_name(static_cast<Outcome>(i))) {
      return field;
    }
  }
  return "";
}

class StressScenes : public testing::TestWithParam<std::string> {
 protected:
  StressOptions cell(const std::string& method, double step) const {
    StressOptions options;
    options.scene = GetParam();
    options.method = method;
    options.step = step;
    options.set = {"time.duration=" + std::to_string(4 * step)};
    // A few steps of 400 bodies take MuJoCo a minute.
    if (read_scene(GetParam()).scene.model.bodies > most_bodies) {
      options.set.push_back("model.bodies=" + std::to_string(most_bodies));
    }
    options.out = file;
    return options;
  }
  ~StressScenes() override { fs::remove(file); }
  const std::string file =
      (fs::path(testing::TempDir()) / (fs::path(GetParam()).stem().string() + ".csv")).string();
};

TEST_P(StressScenes, ComesBackFromItsOwnText) {
  const ResolvedScene resolved = read_scene(GetParam());
  EXPECT_FALSE(resolved.scene.title.empty());
  const std::string text = scene_to_toml(resolved.scene, resolved.specimen);
  const ResolvedScene again = read_scene_text(text, "again");
  EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
}

TEST_P(StressScenes, EveryMethodHasAnOutcomeByName) {
  for (const std::string& method : stress_methods()) {
    for (const double step : {0.0002, 0.05}) {
      SCOPED_TRACE(method);
      ASSERT_EQ(stress(cell(method, step)), 0);
      EXPECT_NE(outcome_in(file), "") << step;
    }
  }
}

/// A cell of the map that once failed by the default method, and what it failed of then.
struct MendedCell {
  std::string name, scene;
  double step;
  std::vector<std::string> set;
};

class MendedCells : public testing::TestWithParam<MendedCell> {};

TEST_P(MendedCells, StayMended) {
  const MendedCell& cell = GetParam();
  const std::string file =
      (fs::path(testing::TempDir()) / ("mended_" + cell.name + ".csv")).string();
  StressOptions options;
  options.scene =
      cell.scene == "table1" ? cell.scene : (fs::path(HAGFISH_STRESS_DIR) / cell.scene).string();
  options.step = cell.step;
  options.set = cell.set;
  options.out = file;
  ASSERT_EQ(stress(options), 0);
  EXPECT_EQ(outcome_in(file), outcome_name(Outcome::ok));
  fs::remove(file);
}

const MendedCell mended_cells[] = {
    // Explicit Coriolis forces made energy until the body flew apart.
    {"whip_2ms", "whip.toml", 0.002, {}},
    {"spinning_5ms", "spinning.toml", 0.005, {}},
    // Strands passed through each other.
    {"closing_1000_5ms", "closing.toml", 0.005, {}},
    {"closing_1000_20ms", "closing.toml", 0.02, {}},
    {"pulled_knot_20ms", "pulled_knot.toml", 0.02, {}},
    // Pushed out with the speed of a blast.
    {"overlap_1ms", "overlap.toml", 0.001, {}},
    {"tight_bend_2ms", "tight_bend.toml", 0.002, {}},
    // The path between linear rows overlapped by 0.0059 and 0.0092 cm.
    {"table1_10ms", "table1", 0.01, {}},
    {"table1_20ms", "table1", 0.02, {}},
    // Tightened a tangle that passed for the knot.
    {"table1_noise", "table1", 0.005, {"start.noise_deg=0.3", "start.seed=6"}},
};
INSTANTIATE_TEST_SUITE_P(Stability, MendedCells, testing::ValuesIn(mended_cells),
                         [](const auto& cell) { return cell.param.name; });

INSTANTIATE_TEST_SUITE_P(Stability, StressScenes, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return fs::path(scene.param).stem().string(); });

}  // namespace
}  // namespace hagfish
