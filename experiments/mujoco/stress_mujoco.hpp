// A stress scene in MuJoCo, with its own contacts and limits.
#pragma once

#include <functional>
#include <string>

#include "experiments/mujoco/stress_judge.hpp"

namespace hagfish {

/// Why a scene cannot be mirrored in MuJoCo; empty where it can: thigmotaxis and the head plate are
/// the core's.
std::string not_in_mujoco(const Scene& scene);

/// Kinetic, elastic and gravity energy, by the core's own formulas, erg.
double mechanical_energy(const Model& model, const State& state, const Kinematics& kin);

/// Runs `scene` by MuJoCo's `integrator` (mjINT_...) from its start to its end: its own soft
/// contacts and limits (margin 0, all else at its defaults; where `hard`, stiff ones),
/// the scene's drag and script as forces of the step's beginning. The core's guards hold here too.
/// `judge` sees each step; a call of `out_of_time` ends the run where it says so. Returns whether
/// it came to its end. Throws StepError where MuJoCo finds its state bad or a guard is passed.
bool run_in_mujoco(const Model& model, const Scene& scene, const State& start, int integrator,
                   bool hard, const std::function<bool()>& out_of_time, StressJudge& judge);

}  // namespace hagfish
