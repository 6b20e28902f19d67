// The script that forms the knot by forward dynamics (paper, 3.2): the force on the last body over
// time.
#pragma once

#include <Eigen/Core>

#include "core/chain/dynamics.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Value of a script at `time`, constant outside its waypoints. Forces are linear between these.
/// Positions are a Catmull-Rom spline through time.
Eigen::Vector3d script_value(const ScriptSettings& script, double time);

/// Time of the last waypoint or of the curvature program's last shape, s; 0 without a script.
double script_end(const ScriptSettings& script);

/// The script's force on the last body for the step from `time`; none with a curvature program. A
/// position script pulls with a spring and damper towards its value when the step's forces act
/// (TimeSettings::reach). The pull is implicit up to largest_force; above this the force is
/// constant within the step. By the midpoint rule the damper is at least reach times spring, which
/// keeps it from ringing from step to step. `position`, `velocity`: the last body's centre, world,
/// cm and cm/s.
TipForce script_force(const ScriptSettings& script, double time, const TimeSettings& step,
                      const Eigen::Vector3d& position, const Eigen::Vector3d& velocity);

}  // namespace hagfish
