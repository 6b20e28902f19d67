// The reflex by muscles alone (addition).
#include "core/control/controller.hpp"
#include "core/control/muscle_law.hpp"
#include "core/control/reflex.hpp"
#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

/// Stands for each angle that the senses have not shown yet, rad: no hinge turns so far. The memory
/// has one length, while that of reflex_law is empty at first.
constexpr double none = 1e6;

/// Storage of reflex_muscles_law.
struct ReflexMusclesStorage {
  ReflexStorage reflex;
  Eigen::VectorXd senses;  ///< memory of the reflex
  ActiveTorque active;
  Eigen::VectorXd torque;  ///< torque that is asked for, dyn cm, nv
  ActivationSolver activations;
  MuscleEffort wanted;
};

/// Activations alone move the animal. Excitations are the activations that would give the torques
/// of reflex_law, and the activations follow them by first-order dynamics. While the knot forms,
/// excitations are ahead by that lag, and from the release on nothing is excited, as in muscle_law.
///
/// `memory`: that of reflex_law, padded where it is empty, then the activations.
void reflex_muscles_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                        ReflexMusclesStorage& storage) {
  const auto& [model, scene, now, time, so_far] = at;
  const Kinematics& kin = now.observation.kin;
  const Eigen::Index muscles = model.muscle_count();
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

}  // namespace

extern constinit const Law reflex_muscles_record =
    driven_law({.name = "reflex_muscles",
                .description = "the reflex by activations of muscles alone",
                .make = law_with_storage<ReflexMusclesStorage, reflex_muscles_law>,
                .memory_size =
                    [](const Model& model, const Scene& scene) {
                      return reflex_memory_size(model, scene) + model.muscle_count();
                    },
                .fault =
                    [](const Specimen& specimen, const Scene& scene) {
                      std::optional<SceneFault> found = driven_fault(scene);
                      return found ? found : reflex_fault(specimen, scene);
                    },
                .bends = true,
                .table = "reflex"});

}  // namespace hagfish
