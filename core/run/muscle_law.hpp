// The animal moves by the activations of its muscles (addition).
#pragma once

#include "core/muscle/activation.hpp"
#include "core/run/untaken_step.hpp"

namespace hagfish {

/// The dataset of the activations that move the animal.
inline constexpr const char* driven_activations = "/muscle/driven";

/// Storage of muscle_law.
struct MuscleStorage {
  UntakenStep paper;            ///< the paper's law's
  Eigen::VectorXd shape_ahead;  ///< the program's when the muscles answer, rad, nv
  Eigen::VectorXd torque;       ///< what that step takes, dyn cm, nv
  ActivationSolver activations;
  MuscleEffort wanted;
};

/// Activations alone move the animal: no rows of Eq. 6, no torques towards a rest shape.
/// Excitations e are those activations that would give what the paper's law asks for in this step,
/// u + f_thigmo, by the step solved with its rows and not taken; activations follow them by
/// first-order dynamics, a' = (e - a) / activation_time, and act as R(q) a F_max, constant within
/// the step. While the knot forms, u is a stiff spring towards the program's shape, about which a
/// body whose muscles lag would swing ever further: what is asked for is u as it will be
/// activation_time later, towards the shape then from where the motion leads, which takes the lag
/// out of that loop. Tone, which follows the body, resists motion only and needs no such
/// thing. From release on nothing is excited, and the body's own stiffness pushes the knot off and
/// straightens it: what is excited when the knot comes off would throw the body. A script's tip
/// force and the head's clamp stay as they are. What f_thigmo does at the root, where no muscle
/// holds, is left out.
///
/// `memory`: the rest shape of the paper's law (nv), then the activations. Throws StepError where
/// the step that is not taken cannot be solved.
void muscle_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                MuscleStorage& storage);

/// The activations in the law's memory: 0 to 1, one for each of Model::muscles.
Eigen::VectorXd activations_in(const Model& model, const Eigen::VectorXd& memory);

}  // namespace hagfish
