#include "experiments/common/scene_sense.hpp"

#include <fmt/format.h>

#include <numbers>

#include "core/input/input_error.hpp"
#include "core/log/log_frame.hpp"
#include "experiments/common/terminal.hpp"

namespace hagfish {
namespace {

constexpr double most_steps = 1e8;
constexpr double most_bytes = 1e10;
constexpr double water = 1;        // g/cm^3; animals are within some per cent of it
constexpr double odd_ratio = 1.5;  // of densities, either way
constexpr double densest = 22.6;   // osmium, g/cm^3
constexpr double longest = 130;    // cm; the largest hagfish, Eptatretus goliath, has 127.5

/// Mass over the volume of the skin.
double density(const Model& model) {
  double volume = 0, mass = 0;
  for (const Body& body : model.bodies) {
    volume += std::numbers::pi * body.radius * body.radius * body.length;
    mass += body.mass;
  }
  return mass / volume;
}

double row_bytes(const SeriesList& table) {
  std::size_t bytes = 0;
  for (const auto& series : table) {
    bytes += series->row_bytes();
  }
  return static_cast<double>(bytes);
}

}  // namespace

RunSize run_size(const Scene& scene, const Model& model) {
  const double count = scene.time.duration / scene.time.step;
  return {count, count * row_bytes(step_table(scene, LogLevel::full).series()) +
                     scene.time.duration / scene.time.frame_interval *
                         row_bytes(frame_table(model, scene, LogLevel::full).series())};
}

std::vector<std::string> odd_things(const ResolvedScene& scene) {
  std::vector<std::string> odd;
  const double dense = density(scene.model);
  if (dense > odd_ratio * water || dense < water / odd_ratio) {
    odd.push_back(
        fmt::format("specimen: a density of {:.3g} g/cm^3, but an animal has about 1; built-in "
                    "scripts may not tie it",
                    dense));
  }
  if (scene.specimen.length > longest) {
    odd.push_back(
        fmt::format("specimen.length = {:g} cm: the largest hagfish are {:g} cm long; built-in "
                    "scripts may not tie this animal",
                    scene.specimen.length, longest));
  }
  const std::vector<double>& range = scene.specimen.flesh.stiffness_range;
  const double stiffness = scene.scene.flesh.stiffness;
  if (stiffness > 0 && !range.empty() && (stiffness < range[0] || stiffness > range[1])) {
    odd.push_back(
        fmt::format("flesh.stiffness = {:g} dyn/cm^2 is not what the animal may have, {:g} to {:g}",
                    stiffness, range[0], range[1]));
  }
  return odd;
}

void check_sense(const ResolvedScene& scene, bool force) {
  if (scene.scene.controller.law == own_law) {
    throw InputError(
        R"(controller.law = "own": only a C++ or Python program that sets a control law can run this scene)");
  }
  if (const double dense = density(scene.model); dense > densest) {
    throw InputError(fmt::format(
        "specimen: a density of {:.3g} g/cm^3 is more than any matter has ({:g}); is mass "
        "in g, and length in cm?",
        dense, densest));
  }
  const RunSize size = run_size(scene.scene, scene.model);
  if (!force && (size.steps > most_steps || size.bytes > most_bytes)) {
    throw InputError(fmt::format(
        "time.duration = {:g} s at time.step = {:g} s: {:.3g} steps and up to {:.3g} GB of log. "
        "More than {:g} steps or {:g} GB need --force",
        scene.scene.time.duration, scene.scene.time.step, size.steps, 1e-9 * size.bytes, most_steps,
        1e-9 * most_bytes));
  }
}

void warn_of_odd_things(const ResolvedScene& scene) {
  for (const std::string& odd : odd_things(scene)) {
    say("hagfish: warning: {}\n", odd);
  }
}

}  // namespace hagfish
