// The core's states and the core's rule of motion in MuJoCo.
#pragma once

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// How the head hangs in a MuJoCo model made by mjcf_files() of `model`.
inline Head head_of(const mjModel& mirror, const Model& model) {
  return mirror.nv == model.nv() ? Head::free : Head::clamped;
}

/// Copies a state of `model` into its mirror; of a clamped head's root nothing is copied.
void set_state(const Model& model, const State& state, MujocoModel& mirror);

/// The mirror's state; a clamped head lies at the origin, along +X, at rest.
State state_of(const Model& model, const MujocoModel& mirror);

/// Makes mj_step take the core's step: semi-implicit Euler without contacts and limits. MuJoCo
/// takes joint damping implicitly but not stiffness; h k more damping does that, since
/// M + h (D + h K) is the core's H without drag. Once per model.
void use_core_rule(MujocoModel& mirror);

/// Sets how contacts and limits give way: the time constant `constant` (s, solref) in which they
/// come back, of which MuJoCo allows no less than two steps, and the share of a violation's
/// acceleration that they take (solimp). Contacts begin where skins touch (margin 0).
void set_stiffness(double constant, double share, mjModel& mirror);

/// Throws StepError where MuJoCo found a state bad since its data were made or reset: it sets such
/// a state back to the initial one and goes on.
void check_stable(const MujocoModel& mirror);

}  // namespace hagfish
