// The animal moves by the activations of its muscles (addition).
#pragma once

#include "core/run/control_law.hpp"

namespace hagfish {

/// Activations alone move the animal: no rows of Eq. 6, no torques towards a rest shape.
/// Excitations e are those activations that would give what the paper's law asks for in this step,
/// u + f_thigmo, by the step solved with its rows and not taken; activations follow them by
/// first-order dynamics, a' = (e - a) / activation_time, and act as R(q) a F_max, constant within
/// the step. Once the knot is gone (Phase::free) nothing is excited, and the body's own stiffness
/// straightens it: pulled straight by torques that lag behind, it would swing ever further. A
/// script's tip force and the head's clamp stay as they are. What f_thigmo does at the root, where
/// no muscle holds, is left out.
///
/// `memory`: the rest shape of the paper's law (nv), then the activations. The step that is not
/// taken is solved from no warm start, so that what the law does follows from state and memory, in
/// storage of its own: unlike other laws this one asks for memory in each step. Throws StepError
/// where that step cannot be taken.
void muscle_law(const Situation& at, Eigen::VectorXd& memory, Control& control);

/// The activations in the law's memory: 0 to 1, one for each of Model::muscles.
Eigen::VectorXd activations_in(const Model& model, const Eigen::VectorXd& memory);

}  // namespace hagfish
