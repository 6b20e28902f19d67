// The reflex by muscles alone (addition).
#pragma once

#include "core/muscle/activation.hpp"
#include "core/run/reflex.hpp"

namespace hagfish {

/// Storage of reflex_muscles_law.
struct ReflexMusclesStorage {
  ReflexStorage reflex;
  Eigen::VectorXd senses;  ///< memory of the reflex
  ActiveTorque active;
  Eigen::VectorXd torque;  ///< that is asked for, dyn cm, nv
  ActivationSolver activations;
  MuscleEffort wanted;
};

/// Activations alone move the animal: excitations are those activations that would give the torques
/// of reflex_law, and activations follow them by first-order dynamics. While the knot forms they
/// are asked for ahead of that lag, and from release on nothing is excited, as in muscle_law.
///
/// `memory`: that of reflex_law, filled up where it is empty, then the activations.
void reflex_muscles_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                        ReflexMusclesStorage& storage);

}  // namespace hagfish
