#include "experiments/sweep/sure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace hagfish {
namespace {

// Meshes beside the paper's: some near it, since the least change of a mesh may do what a large one
// does.
constexpr std::array bodies{60, 80, 90, 96, 99, 101, 104, 110, 125, 150, 175, 200};
constexpr std::array finer{2, 4,
                           5};  // parts of the scene's step: frames stay whole numbers of steps
constexpr std::array off{0.95, 1.05};  // how well girth and limits are known
// EI of hagfish: 3e4 to 1.2e6 dyn cm^2 about 2e5 (data/specimens/pacific_hagfish.toml). What is the
// scene's own has no known range, and is changed as much.
constexpr std::array stiffness{0.15, 0.4, 2.5, 6.0};
constexpr double chance_deg = 1e-6;  // what starts differ by that nobody could tell apart
constexpr double start_deg = 0.1;    // and what an animal's may
constexpr int draws = 4;

std::string number(double value) { return fmt::format("{:.9g}", value); }

std::string scaled(const std::vector<double>& values, double by) {
  std::vector<std::string> all;
  for (const double value : values) all.push_back(number(by * value));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

void add_starts(const std::string& cause, double noise_deg, std::vector<SureCase>& cases) {
  for (int seed = 1; seed <= draws; ++seed) {
    cases.push_back(
        {cause, {{"start.noise_deg", number(noise_deg)}, {"start.seed", fmt::to_string(seed)}}});
  }
}

/// Stiffness and damping together: of the animal where the scene takes its own.
SureCase stiffer(const ResolvedScene& resolved, double by) {
  SureCase changed{"stiffness", {}};
  const ModelSettings& model = resolved.scene.model;
  const Specimen& animal = resolved.specimen;
  if (model.passive == PassiveSource::specimen) {
    changed.set = {{"specimen.passive.bending_stiffness", scaled(animal.bending_stiffness, by)},
                   {"specimen.passive.bending_damping", scaled(animal.bending_damping, by)},
                   {"specimen.passive.twist_stiffness", scaled(animal.twist_stiffness, by)},
                   {"specimen.passive.twist_damping", scaled(animal.twist_damping, by)}};
  } else {
    changed.set = {{"model.bending_stiffness", number(by * model.bending_stiffness)},
                   {"model.bending_damping", number(by * model.bending_damping)},
                   {"model.twist_stiffness", number(by * model.twist_stiffness)},
                   {"model.twist_damping", number(by * model.twist_damping)}};
  }
  return changed;
}

}  // namespace

std::vector<SureCase> sure_cases(const ResolvedScene& resolved) {
  const Scene& scene = resolved.scene;
  std::vector<SureCase> cases{{"as it is", {}}};
  add_starts("chance", chance_deg, cases);
  for (const int parts : finer) {
    cases.push_back({"step", {{"time.step", number(scene.time.step / parts)}}});
  }
  for (const int count : bodies) {
    if (count != scene.model.bodies) {
      cases.push_back({"bodies", {{"model.bodies", fmt::to_string(count)}}});
    }
  }
  add_starts("start", start_deg, cases);
  for (const double by : off) {
    cases.push_back(
        {"girth", {{"specimen.circumference", scaled(resolved.specimen.circumference, by)}}});
  }
  for (const double by : off) {
    cases.push_back({"limits", {{"model.limit_scale", number(by * scene.model.limit_scale)}}});
  }
  for (const double by : stiffness) cases.push_back(stiffer(resolved, by));
  return cases;
}

Grid sure_grid(const std::string& scene, const std::vector<std::string>& set,
               const std::vector<SureCase>& cases) {
  Grid grid;
  grid.file = "sure";
  grid.scene = scene;
  grid.set = set;
  GridAxis axis;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (const auto& [key, value] : cases[c].set) {
      auto at = std::ranges::find(axis.keys, key);
      if (at == axis.keys.end()) {
        axis.values.emplace_back(cases.size());  // empty: as the scene has it
        at = axis.keys.insert(axis.keys.end(), key);
      }
      axis.values[static_cast<std::size_t>(at - axis.keys.begin())][c] = value;
    }
  }
  grid.axes = {axis};
  return grid;
}

}  // namespace hagfish
