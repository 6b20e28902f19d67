// The scenes of experiments/results/stability/study.sh: each is read, runs for four steps by the
// core and in MuJoCo, and ends in the outcome that the scene is made for.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "experiments/common/scene_argument.hpp"
#include "experiments/mujoco/stress.hpp"

namespace hagfish::stress_scenes_test {

namespace fs = std::filesystem;

constexpr int most_bodies = 100;
constexpr double cpu_limit = 600;  // s: none comes near, with sanitizers either

std::vector<std::string> scenes() {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(HAGFISH_STRESS_DIR)) {
    found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// A scene run by a method at a step, with overrides after the method's.
StressResult run_cell(const std::string& scene, const std::string& method, double step,
                      const std::vector<std::string>& more) {
  std::vector<std::string> set = stress_overrides(method, step);
  set.insert(set.end(), more.begin(), more.end());
  const ResolvedScene resolved = scene_argument(scene, set);
  return stress(resolved.scene, resolved.model, method, cpu_limit);
}

class StressScenes : public testing::TestWithParam<std::string> {
 protected:
  /// What becomes of four steps of `step` (s) by `method`.
  static std::string outcome(const std::string& method, double step) {
    std::vector<std::string> set = {"time.duration=" + std::to_string(4 * step)};
    // A few steps of 400 bodies take MuJoCo a minute.
    if (scene_argument(GetParam(), {}).scene.model.bodies > most_bodies) {
      set.push_back("model.bodies=" + std::to_string(most_bodies));
    }
    const StressResult result = run_cell(GetParam(), method, step, set);
    EXPECT_EQ(result.status.message.empty(), result.status.ok()) << result.status.message;
    EXPECT_LE(result.figures.time, 4.5 * step) << "to half a step";
    return outcome_name(result.status.outcome);
  }

  const std::string name = fs::path(GetParam()).stem();
  /// Eq. 6 cannot be met there.
  const bool unmeetable = name == "knot_into_head" || name == "parallel";
  const bool contradictory = name == "contradictory";
  static constexpr double small_step = 0.0002, large_step = 0.05;  // s, the ends of the map
};

TEST_P(StressScenes, SmallStepsOfTheCoreAreSurvivedByEveryMethod) {
  for (const std::string& method : stress_methods()) {
    // Without the watch bodies are too fast in some scenes: RuleCells.
    if (method.starts_with("mujoco") || method == "no_watch" || method == "midpoint") continue;
    // Hard rows cannot be met there: where the knot touches itself elsewhere they can.
    const bool hard = unmeetable && method == "hard_thigmotaxis";
    const std::string found = outcome(method, small_step);
    if (hard && found == "ok") continue;
    EXPECT_EQ(found, hard ? "solver failed" : contradictory ? "infeasible" : "ok") << method;
  }
}

TEST_P(StressScenes, LargeStepsAreSurvivedByTheDefaultWithEitherBackEnd) {
  const std::string expected = contradictory ? "infeasible" : "ok";
  EXPECT_EQ(outcome("default", large_step), expected);
  EXPECT_EQ(outcome("ipopt", large_step), expected);
}

TEST_P(StressScenes, MujocoSurvivesSmallStepsOfWhatItHas) {
  for (const std::string method : {"mujoco_euler", "mujoco_implicit", "mujoco_rk4"}) {
    if (contradictory || unmeetable) {  // head plate, thigmotaxis
      EXPECT_EQ(outcome(method, small_step), "not applicable") << method;
    } else if (name == "closing") {  // its contacts give way by design
      EXPECT_EQ(outcome(method, small_step), "penetration") << method;
    } else {
      EXPECT_EQ(outcome(method, small_step), "ok") << method;
    }
  }
}

TEST(StressMethods, StiffContactsOfMujocoHoldLimitsThatItsOwnDoNot) {
  const std::string scene = HAGFISH_STRESS_DIR "/tight_limits.toml";
  EXPECT_EQ(run_cell(scene, "mujoco_euler", 0.001, {}).status.outcome, Outcome::limits);
  EXPECT_EQ(run_cell(scene, "mujoco_hard", 0.001, {}).status.outcome, Outcome::ok);
}

/// A long step (s) at which a scene passes by a rule with the watch off. What lies beyond, and what
/// chance does, is the map's to tell (experiments/results/stability/study.sh). Of whole knots:
/// knot_scenes_test.cpp.
struct RuleCell {
  std::string method, scene;
  double step;
};

const RuleCell rule_cells[] = {
    {"no_watch", "short_bodies", 0.002},
    {"no_watch", "pulled_knot", 0.002},
    {"no_watch", "knot_into_head", 0.005},
    {"no_watch", "parallel", 0.001},
    {"no_watch", "stiff_joints", 0.05},
    {"no_watch", "stiff_tip", 0.05},
    {"no_watch", "coil", 0.05},
    {"no_watch", "mass_ratio", 0.05},
    {"no_watch", "overlap", 0.05},
    {"no_watch", "redundant", 0.05},
    {"no_watch", "tight_limits", 0.01},
    {"midpoint", "whip", 0.002},
    {"midpoint", "spinning", 0.01},
    {"midpoint", "tight_bend", 0.002},
    {"midpoint", "short_bodies", 0.02},
    {"midpoint", "pulled_knot", 0.01},
    {"midpoint", "knot_into_head", 0.02},
    {"midpoint", "parallel", 0.02},
    {"midpoint", "stiff_joints", 0.05},
    {"midpoint", "stiff_tip", 0.02},
    {"midpoint", "closing", 0.0005},
    {"midpoint", "coil", 0.05},
    {"midpoint", "mass_ratio", 0.05},
    {"midpoint", "overlap", 0.05},
    {"midpoint", "redundant", 0.05},
    {"midpoint", "tight_limits", 0.02},
};
class RuleCells : public testing::TestWithParam<RuleCell> {};

TEST_P(RuleCells, PassWithoutTheWatch) {
  const auto& [method, scene, step] = GetParam();
  for (const char* seed : {"1", "2"}) {
    const StressResult result =
        run_cell((fs::path(HAGFISH_STRESS_DIR) / (scene + ".toml")).string(), method, step,
                 {"start.noise_deg=1e-4", std::string("start.seed=") + seed});
    EXPECT_EQ(result.status.outcome, Outcome::ok) << seed << ": " << result.status.message;
  }
}
INSTANTIATE_TEST_SUITE_P(Stability, RuleCells, testing::ValuesIn(rule_cells), [](const auto& cell) {
  return cell.param.method + "_" + cell.param.scene;
});

INSTANTIATE_TEST_SUITE_P(Stability, StressScenes, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return fs::path(scene.param).stem().string(); });

TEST(StressOfAFirstStep, ThatIsTooFastHasAnOutcome) {
  const StressResult result = run_cell((fs::path(HAGFISH_STRESS_DIR) / "whip.toml").string(),
                                       "default", 0.002, {"guard.speed=1e-6"});
  EXPECT_EQ(result.status.outcome, Outcome::speed) << result.status.message;
}

}  // namespace hagfish::stress_scenes_test
