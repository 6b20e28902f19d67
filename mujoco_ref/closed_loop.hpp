// A run in MuJoCo, in closed loop: what the animal senses, decides and asks of its muscles is the
// scene's, as in any run; how it moves, touches itself and meets its joint limits is MuJoCo's.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/run/simulation.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// MuJoCo's ways to take a step. Euler's and the implicit one take damping implicitly, and with it
/// springs and muscles, of which a step makes dampers; by RK4 all is explicit, and applied forces
/// are those of the step's start.
enum class MujocoIntegrator { euler, implicit, rk4 };

/// How MuJoCo takes its steps, and how hard its contacts and limits are: they are springs and
/// dampers that bodies sink into.
struct MujocoSettings {
  MujocoIntegrator integrator = MujocoIntegrator::euler;
  /// Time constant (solref) of critically damped contacts and limits, s. MuJoCo takes no less than
  /// two steps; its default, 0.02, lets the strands of a tight knot overlap by half a millimetre.
  double contact_time = 0.005;
};

/// Takes the steps of a run in MuJoCo, at the scene's time step: Newton's solver with a dense
/// Jacobian, which is its quickest here, and the capsules of mjcf.hpp. Muscles and water drag are
/// applied as generalised forces (qfrc_applied), explicitly, from the state at the start of the
/// step. A law that asks for rows of Eq. 6 ends the run. A clamped head is part of the world.
class MujocoLoop {
 public:
  /// `model` and `scene` are referred to. Throws InputError, one line, where the scene asks for
  /// what MuJoCo has not: obstacles, flesh, a script's force on the tail, the midpoint rule.
  MujocoLoop(const Model& model, const Scene& scene, const MujocoSettings& settings = {});

  /// Takes a step as hagfish::take_step() does. The solution in `record` has the velocities,
  /// contacts and limits with their forces, and the active torque. What MuJoCo does not tell is
  /// nan: the clamp's force, works and residuals. Throws StepError, after which `sim` cannot go on.
  void take_step(Simulation& sim, StepRecord& record);

 private:
  MujocoModel& mirror(Head head);
  void book(double work, const ObservedState& next, Simulation& sim) const;
  bool damps_implicitly() const;
  void apply(const Simulation& sim, const Control& control, MujocoModel& mirror,
             ActiveTorque& muscles) const;
  void note_forces(const Simulation& sim, MujocoModel& mirror, StepSolution& step) const;

  const Model& model_;
  const Scene& scene_;
  MujocoSettings settings_;
  std::optional<MujocoModel> clamped_, free_;
  ActiveTorque muscles_;  ///< sum of all torques of the last step
};

}  // namespace hagfish
