#include "core/run/muscle_law.hpp"

#include <cmath>

#include "core/muscle/activation.hpp"
#include "core/run/active_curvature.hpp"
#include "core/run/controller.hpp"

namespace hagfish {
namespace {

/// Torques of the hinges that the paper's law, whose control this is, takes in a step, dyn cm, nv.
Eigen::VectorXd torques_of(const Situation& at, const Control& control) {
  Midway midway;
  const StepInput in{at.model,     at.scene,
                     at.now.state, at.now.observation,
                     control,      at.scene.time.rule == TimeRule::euler ? nullptr : &midway};
  StepSolver solver("active-set");
  StepSolution step;
  if (Status status = solver.solve(in, step); !status.ok()) {
    throw StepError(status);
  }
  return step.active_torque + step.force[RowKind::thigmotaxis];
}

}  // namespace

void muscle_law(const Situation& at, Eigen::VectorXd& memory, Control& control) {
  const auto& [model, scene, now, time, so_far] = at;
  const auto count = static_cast<Eigen::Index>(model.muscles.size());
  if (memory.size() == 0) {
    memory.setZero(model.nv() + count);
  } else {
    control.rest_shape = memory.head(model.nv());
  }
  paper_law(at, control);
  if (control.rest_shape.size() > 0) {
    active_torque(model, scene, now.state, control.rest_shape, control.active);
    memory.head(model.nv()) = control.rest_shape;
  }
  MuscleEffort wanted;
  if (so_far.phase == Phase::free) {
    wanted.activation.setZero(count);
  } else {
    ActivationSolver().solve(model, now.observation.kin, torques_of(at, control), wanted);
  }
  auto activation = memory.tail(count);
  const double kept = std::exp(-scene.time.step / scene.muscle.activation_time);
  activation = wanted.activation + kept * (activation - wanted.activation);
  control.rest_shape.resize(0);
  control.thigmotaxis.clear();
  muscle_torque(model, now.observation.kin, activation, control.torque.value);
  control.torque.rate.setZero(model.nv());
}

Eigen::VectorXd activations_in(const Model& model, const Eigen::VectorXd& memory) {
  return memory.tail(static_cast<Eigen::Index>(model.muscles.size()));
}

}  // namespace hagfish
