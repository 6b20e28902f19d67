// The animal moves by the activations of its muscles (addition).
#pragma once

#include <optional>
#include <string>

#include "core/muscle/activation.hpp"
#include "core/muscle/paths.hpp"
#include "core/run/laws.hpp"
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

/// The step of a law that moves the animal by activations alone: those at the end of its `memory`,
/// 0 to 1, one for each of Model::muscles, follow `excitation` and make the torques of `control`.
void drive_muscles(const Situation& at, const Eigen::VectorXd& excitation, Eigen::VectorXd& memory,
                   Control& control);

/// What keeps a scene from having such a law.
std::optional<SceneFault> driven_fault(const Scene& scene);

inline constexpr LawNumbers driven_numbers[] = {
    {.path = driven_activations,
     .unit = "1",
     .description =
         "activations, 0 to 1, that move the animal in the step that begins at the frame",
     .of = [](const Eigen::VectorXd& memory, Eigen::Index size) {
       return Eigen::VectorXd(memory.tail(size));
     }}};

/// The record of such a law: what it logs, and what an audit may ask of it.
constexpr Law driven_law(Law law) {
  law.numbers = driven_numbers;
  law.rows = [](const Scene& /*scene*/, Phase /*phase*/) { return AskedRows{.any = false}; };
  law.rest_shape = [](const LoggedSituation& /*at*/) { return std::optional(Eigen::VectorXd()); };
  law.torque = [](const LoggedSituation& at) {
    Eigen::VectorXd torque;
    muscle_torque(at.model, at.kin, at.numbers[0], torque);
    return torque;
  };
  return law;
}

}  // namespace hagfish
