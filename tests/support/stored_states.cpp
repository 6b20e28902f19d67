#include "tests/support/stored_states.hpp"

#include <algorithm>
#include <cmath>
#include <toml.hpp>

namespace hagfish {
namespace {

/// Step of the run that the states were stored from, s.
constexpr double stored_step = 0.002;

}  // namespace

std::string name_of(const testing::TestParamInfo<StoredState>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::vector<StoredState> stored_states() {
  const auto file = toml::parse(HAGFISH_TEST_DATA_DIR "/table1_states.toml");
  std::vector<StoredState> states;
  for (const auto& entry : toml::find<std::vector<toml::value>>(file, "state")) {
    const auto numbers = [&entry](const char* key) {
      const auto values = toml::find<std::vector<double>>(entry, key);
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()));
    };
    StoredState stored;
    stored.name = toml::find<std::string>(entry, "name");
    stored.phase = static_cast<Phase>(toml::find<int>(entry, "phase"));
    stored.step = toml::find<std::int64_t>(entry, "step");
    stored.state = {numbers("q"), numbers("qdot")};
    states.push_back(std::move(stored));
  }
  return states;
}

StoredState stored_state(const std::string& name) {
  const std::vector<StoredState> states = stored_states();
  return states.at(std::ranges::find(states, name, &StoredState::name) - states.begin());
}

ResolvedScene stored_scene(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"time.step=" + std::to_string(stored_step)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scene_argument("table1", all);
}

Simulation resume(const Model& model, const Scene& scene, const StoredState& stored,
                  const std::string& back_end) {
  ControllerState controller;
  controller.phase = stored.phase;
  controller.phase_start = static_cast<double>(stored.step) * stored_step;
  controller.loose = controller.phase_start;
  return start_from(model, scene, back_end, stored.state, controller,
                    std::llround(controller.phase_start / scene.time.step));
}

SceneRun resumed(const StoredState& stored, const std::vector<std::string>& overrides) {
  SceneRun run(stored_scene(overrides));
  run.sim = resume(run.model, run.scene, stored);
  return run;
}

}  // namespace hagfish
