// Motion in both simulators from one state, of the chain alone: no contacts, limits, drag or
// script.
#pragma once

#include <vector>

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// `model` without joint limits, drag and skin: what both simulators share outside of constraints.
Model smooth(Model model);

/// States after each of `steps` steps of h (s) of the core from `start`: Eq. 1, Eq. 3 where the
/// head is clamped, and Eq. 2. Wants a smooth model. Throws StepError.
std::vector<State> core_rollout(const Model& model, const State& start, Head head, TimeRule rule,
                                double h, int steps);

/// These states in MuJoCo, by the rule and timestep that `mirror` is set to. Throws StepError where
/// MuJoCo finds its state bad, which it would otherwise reset and go on.
std::vector<State> mujoco_rollout(const Model& model, const State& start, MujocoModel& mirror,
                                  int steps);

/// Largest |Δq̇_i| over the largest |q̇_i| of `b` (1 where all is at rest).
double velocity_difference(const State& a, const State& b);

/// Largest distance between the bodies' centres of two states of one model, cm.
double centre_distance(const Model& model, const State& a, const State& b);

}  // namespace hagfish
