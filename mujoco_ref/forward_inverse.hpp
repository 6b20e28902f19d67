// Forces put back: what MuJoCo makes of the forces that the core says it used.
#pragma once

#include <Eigen/Core>

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/step/midpoint/midway.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// q̇ (nv) after one step of MuJoCo from `state` under the generalised force `force` (nv; dyn,
/// dyn cm) and the force `tip` (dyn, world) on the last body's centre, beside the springs, dampers
/// and gravity of the mirror itself. `mirror` has a free head and the core's rule (mirror.hpp).
Eigen::VectorXd driven_velocity(const Model& model, const State& state,
                                const Eigen::VectorXd& force, const Eigen::Vector3d& tip,
                                MujocoModel& mirror);

/// What makes driven_velocity from the middle of a step, as `midway` places it, take the first half
/// of the midpoint rule's step, `reach` (s), to the mean of the velocities before and after it
/// (nv): the momentum of the step's start, the springs at its start, and the bias of a body that
/// moves by one velocity and has another.
Eigen::VectorXd midway_force(const Model& model, const State& start, const Midway& midway,
                             double reach, MujocoModel& mirror);

}  // namespace hagfish
