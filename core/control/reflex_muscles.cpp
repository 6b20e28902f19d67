#include "core/control/reflex_muscles.hpp"

#include "core/control/controller.hpp"
#include "core/control/muscle_law.hpp"
#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

/// Stands for each angle that the senses have not shown yet, rad: no hinge turns so far.
constexpr double none = 1e6;

Eigen::Index muscle_count(const Model& model) {
  return static_cast<Eigen::Index>(model.muscles.size());
}

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
  drive_muscles(at, storage.wanted.activation, memory, control);
}

extern constinit const Law reflex_muscles_record =
    driven_law({.name = "reflex_muscles",
                .description = "the reflex by activations of muscles alone",
                .make = law_with_storage<ReflexMusclesStorage, reflex_muscles_law>,
                .memory_size =
                    [](const Model& model, const Scene& scene) {
                      return reflex_memory_size(model, scene) + muscle_count(model);
                    },
                .fault =
                    [](const Specimen& specimen, const Scene& scene) {
                      std::optional<SceneFault> found = driven_fault(scene);
                      return found ? found : reflex_fault(specimen, scene);
                    },
                .bends = true,
                .table = "reflex"});

}  // namespace hagfish
