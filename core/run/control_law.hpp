// How a controller of one's own is written: a control law says what the animal does in a step, from
// what the run is like at its start. What the laws here have in common, the phases of the
// experiment and the contacts that are the knot's first and last one, is the controller's
// (controller.hpp).
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
  const Moment& now;              ///< state, kinematics, contacts
  double time;                    ///< s
  const ControllerState& so_far;  ///< phase, knot, its first and last contact
};

/// Writes into `control` what the step from `at` shall do. It comes with the head clamped as the
/// scene has it for the phase, the rest shape of the last step (empty at first), no tip force, no
/// commands and torques that are 0 or empty. `memory` is the law's own: what it keeps from step to
/// step, as numbers of any meaning; empty at first, saved in checkpoints, and as it was where a
/// step cannot be taken. A law that keeps anything else is not resumed as it was. May throw, which
/// take_step passes on.
using ControlLaw =
    std::function<void(const Situation& at, Eigen::VectorXd& memory, Control& control)>;

/// The paper's law (3.2): the script while the knot forms, then Eq. 6 at the first and last contact
/// at the commanded speeds of the phase; the rest shape of a scene that has a curvature program.
void paper_law(const Situation& at, Control& control);

/// The left sides of Eq. 6 at `contact` where both strands run along themselves,
/// ẋ_a = speed.a t_a and ẋ_b = speed.b t_b, as those of a knot of constant shape do at one speed:
///
///     t_a . (ẋ_a - ẋ_b) = speed.a - speed.b t_a . t_b
///     t_b . (ẋ_b - ẋ_a) = speed.b - speed.a t_a . t_b
///
/// At one speed v both are v (1 - t_a . t_b): v where strands cross at right angles, 2 v where they
/// run past each other, 0 side by side. There the paper's, v on both rows, contradict each other:
/// they ask for w along t_a and against it. This motion meets both at any angle.
ThigmotaxisSpeeds slip_of_shape(const Contact& contact, const ThigmotaxisSpeeds& speed);

/// The paper's and Eq. 6 at every other contact that touches, while the knot slides: the slip that
/// its strands have at the head contact's speeds (addition).
void all_contacts_law(const Situation& at, Control& control);

/// The paper's, with the commanded speeds of the slide scaled by the knot's measured speed:
/// KnotSpeedSettings (addition). `memory`: smoothed arc length of the head end, cm; scale.
void knot_speed_law(const Situation& at, Eigen::VectorXd& memory, Control& control);

/// What to say besides where a step by `control` ended so: explicit torques that grow from step to
/// step have a cure. Empty where that is not the case.
std::string cure_of_torque(const Control& control, const Status& status);

/// Throws std::invalid_argument in one line where `control` is none for a step of `model`: a vector
/// of another length or with an entry at the root, a number that is not finite, a contact off the
/// body, two commands where one may be, a negative rate or effort.
void check_control(const Model& model, const Control& control);

}  // namespace hagfish
