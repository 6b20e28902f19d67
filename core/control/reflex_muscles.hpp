// The reflex by muscles alone (addition).
#pragma once

#include "core/control/reflex.hpp"
#include "core/muscle/activation.hpp"

namespace hagfish {

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
                        ReflexMusclesStorage& storage);

}  // namespace hagfish
