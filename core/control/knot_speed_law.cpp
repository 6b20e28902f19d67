// A slide at a wanted speed of the knot (addition).
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/control/controller.hpp"
#include "core/control/laws.hpp"

namespace hagfish {
namespace {

/// The memory of knot_speed_law.
constexpr Eigen::Index knot_speed_memory = 2;

std::optional<SceneFault> knot_speed_fault(const Specimen& /*specimen*/, const Scene& scene) {
  const KnotSpeedSettings& loop = scene.controller.knot_speed;
  for (const auto& [key, value] :
       {std::pair("target", loop.target), {"gain", loop.gain}, {"filter", loop.filter}}) {
    if (value == 0) {
      return SceneFault{"controller.knot_speed." + std::string(key),
                        "must be positive where controller.law = \"knot_speed\""};
    }
  }
  return {};
}

/// The paper's law with the speeds of the slide scaled by feedback of the knot's measured speed:
/// KnotSpeedSettings. `memory`: smoothed arc length of the head end, cm; scale.
void knot_speed_law(const Situation& at, Eigen::VectorXd& memory, Control& control) {
  paper_law(at, control);
  if (at.so_far.phase != Phase::slide || control.thigmotaxis.empty()) return;
  const KnotSpeedSettings& loop = at.scene.controller.knot_speed;
  const double h = at.scene.time.step;
  const double arc = control.thigmotaxis[0].contact.arc_a;
  const double kept = std::exp(-h / loop.filter);
  const double lag = h / (1 - kept);  // lag of the last step's smoothed place at steady speed, s
  if (memory.size() == 0) {
    memory.resize(knot_speed_memory);
    memory << arc + lag * loop.target, 1;
  }
  double& smooth = memory[0];
  double& scale = memory[1];
  const double speed = (smooth - arc) / lag;  // towards the head
  smooth = arc + kept * (smooth - arc);
  scale = std::clamp(scale + h * loop.gain * (1 - speed / loop.target), 0.0, loop.most);
  for (ThigmotaxisCommand& command : control.thigmotaxis) {
    command.speed.a *= scale;
    command.speed.b *= scale;
  }
}

}  // namespace

extern constinit const Law knot_speed_record{
    .name = "knot_speed",
    .description = "the paper's, its speeds scaled until the knot has the speed wanted",
    .make = [] { return ControlLaw(knot_speed_law); },
    .memory_size = [](const Model& /*model*/, const Scene& /*scene*/) { return knot_speed_memory; },
    .fault = knot_speed_fault,
    .table = "knot_speed"};

}  // namespace hagfish
