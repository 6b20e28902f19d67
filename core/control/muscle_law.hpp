// The animal moves by the activations of its muscles (addition).
#pragma once

#include <optional>

#include "core/control/laws.hpp"
#include "core/control/untaken_step.hpp"
#include "core/muscle/activation.hpp"
#include "core/muscle/paths.hpp"

namespace hagfish {

/// The dataset of the activations that move the animal.
inline constexpr const char* driven_activations = "/muscle/driven";

/// Storage of muscle_law.
struct MuscleStorage {
  UntakenStep paper;            ///< step of the paper's law
  Eigen::VectorXd shape_ahead;  ///< the program's shape when the muscles answer, rad, nv
  Eigen::VectorXd torque;       ///< torque that this step takes, dyn cm, nv
  ActivationSolver activations;
  MuscleEffort wanted;
};

/// Activations alone move the animal: no rows of Eq. 6, no torques towards a rest shape.
/// Excitations e are the activations that would give the torques of the paper's law, u + f_thigmo.
/// A step that is solved with the paper's rows and not taken yields these torques. Activations
/// follow the excitations, a' = (e - a) / activation_time. They act as R(q) a F_max, constant
/// within the step.
///
/// While the knot forms, u is a stiff spring towards the program's shape. A body whose muscles lag
/// would swing about this shape with growing amplitude. So the law asks for u as it will be after
/// activation_time, from where the motion leads to the shape then. This removes the lag. Tone,
/// which follows the body, only resists motion and does not need it. From the release on nothing is
/// excited, since the torques would throw the body as the knot comes off. The body's own stiffness
/// then pushes the knot off and straightens the body. A script's tip force and the head's clamp
/// stay as they are. The law leaves out f_thigmo at the root, where there is no muscle.
///
/// `memory`: the rest shape of the paper's law (nv), then the activations. Throws StepError if the
/// step that is not taken cannot be solved.
void muscle_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                MuscleStorage& storage);

/// The step of a law that moves the animal by activations alone. The activations are the end of its
/// `memory`, 0 to 1, one for each of Model::muscles. They follow `excitation` and make the torques
/// of `control`.
void drive_muscles(const Situation& at, const Eigen::VectorXd& excitation, Eigen::VectorXd& memory,
                   Control& control);

/// The reason why a scene cannot have such a law, if any.
std::optional<SceneFault> driven_fault(const Scene& scene);

inline constexpr LawNumbers driven_numbers[] = {
    {.path = driven_activations,
     .unit = "1",
     .description =
         "activations, 0 to 1, that move the animal in the step that begins at the frame",
     .of = [](const Eigen::VectorXd& memory, Eigen::Index size) {
       return Eigen::VectorXd(memory.tail(size));
     }}};

/// The record of such a law.
constexpr Law driven_law(Law law) {
  law.numbers = driven_numbers;
  law.asks_for_eq6 = false;
  law.drives_muscles = true;
  return law;
}

}  // namespace hagfish
