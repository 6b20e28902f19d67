#include "core/control/muscle_law.hpp"

#include <cmath>

#include "core/control/controller.hpp"
#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

/// The control of the paper's law for the step from `at`. Its rest shape is in `memory`.
void paper_control(const Situation& at, const Eigen::VectorXd& memory, const Control& given,
                   Eigen::VectorXd& shape_ahead, Control& control) {
  const auto& [model, scene, now, time, so_far] = at;
  control.clamp_head = given.clamp_head;
  control.tip = given.tip;
  control.thigmotaxis.clear();
  if (memory.size() == 0 || scene.script.kind != ScriptSettings::Kind::curvature) {
    control.rest_shape.resize(0);
  } else {
    control.rest_shape = memory.head(model.nv());
  }
  paper_law(at, control);
  if (control.rest_shape.size() == 0) return;
  double ahead = scene.time.reach();
  if (so_far.phase == Phase::form) {
    ahead += scene.muscle.activation_time;
    program_shape(model, scene.script.curvature, time + ahead, shape_ahead);
  }
  active_torque(model, scene.active, now.state,
                so_far.phase == Phase::form ? shape_ahead : control.rest_shape, ahead,
                control.active);
}

Eigen::Index memory_size(const Model& model, const Scene& /*scene*/) {
  return model.nv() + model.muscle_count();
}

}  // namespace

void muscle_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                MuscleStorage& storage) {
  const Model& model = at.model;
  const auto count = model.muscle_count();
  UntakenStep& paper = storage.paper;
  paper_control(at, memory, control, storage.shape_ahead, paper.control);
  control.tip = paper.control.tip;
  if (memory.size() == 0) memory.setZero(memory_size(model, at.scene));
  if (paper.control.rest_shape.size() > 0) memory.head(model.nv()) = paper.control.rest_shape;
  const Kinematics& kin = at.now.observation.kin;
  MuscleEffort& wanted = storage.wanted;
  if (phase_order(at.so_far.phase) >= phase_order(Phase::release)) {
    wanted.activation.setZero(count);
  } else {
    paper.solve(at, at.scene);
    storage.torque = paper.step.active_torque + paper.step.force[RowKind::thigmotaxis];
    storage.activations.solve(model, kin, storage.torque, wanted);
  }
  drive_muscles(at, wanted.activation, memory, control);
}

void drive_muscles(const Situation& at, const Eigen::VectorXd& excitation, Eigen::VectorXd& memory,
                   Control& control) {
  auto activation = memory.tail(excitation.size());
  const double kept = std::exp(-at.scene.time.step / at.scene.muscle.activation_time);
  activation = excitation + kept * (activation - excitation);
  control.rest_shape.resize(0);
  muscle_torque(at.model, at.now.observation.kin, activation, control.torque.value);
  control.torque.rate.setZero(at.model.nv());
}

std::optional<SceneFault> driven_fault(const Scene& scene) {
  const std::string where = " where controller.law = \"" + scene.controller.law + "\"";
  if (!scene.muscle.present) return SceneFault{"muscle.present", "must be true" + where};
  if (scene.muscle.activation_time == 0) {
    return SceneFault{"muscle.activation_time", "must be positive" + where};
  }
  return {};
}

extern constinit const Law muscles_record =
    driven_law({.name = "muscles",
                .description = "activations alone, without rows of Eq. 6",
                .make = law_with_storage<MuscleStorage, muscle_law>,
                .memory_size = memory_size,
                .fault = [](const Specimen& /*specimen*/, const Scene& scene) {
                  return driven_fault(scene);
                }});

}  // namespace hagfish
