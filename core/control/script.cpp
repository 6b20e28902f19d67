#include "core/control/script.hpp"

#include <algorithm>

#include "core/scene/interpolation.hpp"

namespace hagfish {
namespace {

/// Value of a waypoint, including noise.
Eigen::Vector3d at(const Waypoint& waypoint) { return waypoint.value + waypoint.noise; }

/// Catmull-Rom tangent of waypoint k by finite differences in time.
Eigen::Vector3d tangent(const std::vector<Waypoint>& waypoints, std::size_t k) {
  const std::size_t before = k > 0 ? k - 1 : k;
  const std::size_t after = std::min(k + 1, waypoints.size() - 1);
  return (at(waypoints[after]) - at(waypoints[before])) /
         (waypoints[after].time - waypoints[before].time);
}

}  // namespace

double script_end(const ScriptSettings& script) {
  if (script.kind == ScriptSettings::Kind::curvature) return script.curvature.time.back();
  return script.waypoints.empty() ? 0 : script.waypoints.back().time;
}

Eigen::Vector3d script_value(const ScriptSettings& script, double time) {
  const std::vector<Waypoint>& waypoints = script.waypoints;
  const auto [k, u] = bracket_of(waypoints, time, &Waypoint::time);
  if (u == 0) return at(waypoints[k]);
  const double span = waypoints[k + 1].time - waypoints[k].time;
  if (script.kind == ScriptSettings::Kind::force) {
    return (1 - u) * at(waypoints[k]) + u * at(waypoints[k + 1]);
  }
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * at(waypoints[k]) +
         (u3 - 2 * u2 + u) * span * tangent(waypoints, k) +
         (3 * u2 - 2 * u3) * at(waypoints[k + 1]) + (u3 - u2) * span * tangent(waypoints, k + 1);
}

TipForce script_force(const ScriptSettings& script, double time, const TimeSettings& step,
                      const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
  using Kind = ScriptSettings::Kind;
  if (script.kind == Kind::none || script.kind == Kind::curvature) return {};
  if (script.kind == Kind::force) {
    return {script_value(script, step.rule == TimeRule::euler ? time : time + step.reach()), 0};
  }
  const double h = step.reach();
  TipForce implicit{script.spring * (script_value(script, time + h) - position),
                    h * script.spring + script.damper};
  if (step.rule == TimeRule::midpoint) {
    // A spring too stiff for the step rings unless the script damps it. So it is damped at the
    // velocity after the step, 2 x - v (core/README.md, "Steps in time").
    const double ringing = std::max(0.0, h * script.spring - script.damper);
    implicit.value += ringing * velocity;
    implicit.rate += 2 * ringing;
  }
  const Eigen::Vector3d expected = implicit.value - implicit.rate * velocity;
  const double size = expected.norm();
  if (size <= script.largest_force) return implicit;
  return {script.largest_force / size * expected, 0};
}

}  // namespace hagfish
