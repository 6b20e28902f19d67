// Scripted forward dynamics of knot forming (paper, 3.2): what pulls the last body, and when.
#pragma once

#include <Eigen/Core>

#include "core/chain/dynamics.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Value of a script at `time`: forces are linear between knots, positions a Catmull-Rom spline
/// through time; constant outside.
Eigen::Vector3d script_value(const ScriptSettings& script, double time);

/// Time of the last knot or of the curvature program's last shape, s; 0 without a script.
double script_end(const ScriptSettings& script);

/// The script's force on the last body for the step from `time`; none of a curvature program. A
/// position script pulls with a spring-damper towards its value where the step's forces act
/// (TimeSettings::reach), implicitly, up to largest_force, above which the force is constant within
/// the step; by the midpoint rule its damper is no less than what keeps it from ringing from step
/// to step, reach times spring. `position`, `velocity`: the last body's centre, world, cm and cm/s.
TipForce script_force(const ScriptSettings& script, double time, const TimeSettings& step,
                      const Eigen::Vector3d& position, const Eigen::Vector3d& velocity);

}  // namespace hagfish
