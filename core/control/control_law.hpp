// How to write a controller. A control law decides what the animal does in a step, from the state
// of the run at the step's start. All laws share the phases of the experiment and the knot's first
// and last contact, which the controller provides (controller.hpp).
//
//   ControlLaw lazy = [](const Situation& at, Eigen::VectorXd&, Control& control) {
//     paper_law(at, control);
//     for (ThigmotaxisCommand& command : control.thigmotaxis) command.effort = 0.5;
//   };
//   scene.controller.law = own_law;
//   Simulation sim = start(model, scene, "active-set");
//   sim.law = lazy;
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "core/contact/observation.hpp"
#include "core/scene/settings.hpp"
#include "core/step/outcome.hpp"
#include "core/step/step_input.hpp"

namespace hagfish {

struct ControllerState;

/// What a control law sees of a run at the start of a step.
struct Situation {
  const Model& model;
  const Scene& scene;
  const ObservedState& now;       ///< state, kinematics, contacts
  double time;                    ///< s
  const ControllerState& so_far;  ///< phase, knot, its first and last contact
};

/// Writes into `control` what the step from `at` does. At the call `control` holds the scene's
/// clamp of the phase and the rest shape of the last step (empty at first). It holds no tip force
/// and no commands, and its torques are 0 or empty. `memory` is for the law: what it keeps from
/// step to step, as numbers of any meaning. It is empty at first, and restored where a step cannot
/// be taken: a law keeps nothing else. The law may throw; take_step passes this on.
using ControlLaw =
    std::function<void(const Situation& at, Eigen::VectorXd& memory, Control& control)>;

/// The paper's law (3.2): the script while the knot forms, then Eq. 6 at the first and last contact
/// at the commanded speeds of the phase. In a scene with a curvature program it also sets the rest
/// shape.
void paper_law(const Situation& at, Control& control);

/// The paper's law, and while the knot slides also Eq. 6 at every other touching contact, with the
/// slip of its strands at the head contact's speeds (addition).
void all_contacts_law(const Situation& at, Control& control);

/// Advice to add to `status` if explicit torques of `control` may have made the step fail by
/// growing from step to step. Else empty.
std::string cure_of_torque(const Control& control, const Status& status);

/// Throws std::invalid_argument with one line if `control` does not fit a step of `model`: a vector
/// of the wrong length or with an entry at the root, a number that is not finite, a contact off the
/// body, two commands at one place, a negative rate or effort.
void check_control(const Model& model, const Control& control);

}  // namespace hagfish
