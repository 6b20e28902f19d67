#include "core/run/reflex_muscles.hpp"

#include <cmath>

#include "core/muscle/active_curvature.hpp"
#include "core/run/controller.hpp"
#include "core/run/muscle_law.hpp"

namespace hagfish {
namespace {

/// In place of each angle that the senses have not shown yet, rad: no hinge turns so far.
constexpr double none = 1e6;

Eigen::Index muscle_count(const Model& model) {
  return static_cast<Eigen::Index>(model.muscles.size());
}

std::optional<SceneFault> fault(const Specimen& specimen, const Scene& scene) {
  const std::string where = " where controller.law = \"reflex_muscles\"";
  if (!scene.muscle.present) return SceneFault{"muscle.present", "must be true" + where};
  if (scene.muscle.activation_time == 0) {
    return SceneFault{"muscle.activation_time", "must be positive" + where};
  }
  return reflex_fault(specimen, scene);
}

constexpr LawNumbers numbers[] = {
    {.path = driven_activations,
     .unit = "1",
     .description =
         "activations, 0 to 1, that move the animal in the step that begins at the frame",
     .of = [](const Eigen::VectorXd& memory, Eigen::Index size) {
       return Eigen::VectorXd(memory.tail(size));
     }}};

}  // namespace

void reflex_muscles_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                        ReflexMusclesStorage& storage) {
  const auto& [model, scene, now, time, so_far] = at;
  const Kinematics& kin = now.observation.kin;
  const Eigen::Index muscles = muscle_count(model);
  const Eigen::Index senses = reflex_memory_size(model, scene);
  if (memory.size() == 0) {
    memory.setZero(senses + muscles);
    memory.head(senses).setConstant(none);
  }
  const bool late = senses > 0 && memory[0] != none;
  storage.senses = memory.head(late ? senses : 0);
  reflex_law(at, storage.senses, control, storage.reflex);
  if (storage.senses.size() > 0) {
    memory.head(senses) = storage.senses;
  } else {
    memory.head(senses).setConstant(none);
  }
  if (phase_order(so_far.phase) >= phase_order(Phase::release) || control.rest_shape.size() == 0) {
    storage.wanted.activation.setZero(muscles);
  } else {
    double ahead = scene.time.reach();
    if (so_far.phase == Phase::form) {
      ahead += scene.muscle.activation_time;
      program_shape(model, scene.script.curvature, time + ahead, control.rest_shape);
    }
    ActiveTorque& active = storage.active;
    active_torque(model, scene.active, now.state, control.rest_shape, ahead, active);
    storage.torque = active.value - active.rate.cwiseProduct(now.state.qdot);
    storage.activations.solve(model, kin, storage.torque, storage.wanted);
  }
  auto activation = memory.tail(muscles);
  const double kept = std::exp(-scene.time.step / scene.muscle.activation_time);
  activation = storage.wanted.activation + kept * (activation - storage.wanted.activation);
  control.rest_shape.resize(0);
  muscle_torque(model, kin, activation, control.torque.value);
  control.torque.rate.setZero(model.nv());
}

extern constinit const Law reflex_muscles_record{
    .name = "reflex_muscles",
    .description = "the reflex by activations of muscles alone",
    .make = law_with_storage<ReflexMusclesStorage, reflex_muscles_law>,
    .memory_size =
        [](const Model& model, const Scene& scene) {
          return reflex_memory_size(model, scene) + muscle_count(model);
        },
    .fault = fault,
    .numbers = numbers,
    .rows = [](const Scene& /*scene*/, Phase /*phase*/) { return AskedRows{.any = false}; },
    .rest_shape = [](const LoggedSituation& /*at*/) { return std::optional(Eigen::VectorXd()); },
    .torque =
        [](const LoggedSituation& at) {
          Eigen::VectorXd torque;
          muscle_torque(at.model, at.kin, at.numbers[0], torque);
          return torque;
        }};

}  // namespace hagfish
