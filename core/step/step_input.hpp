// What a step depends on, and where its equations hold.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/contact/observation.hpp"
#include "core/step/rows/eq6_rows.hpp"

namespace hagfish {

/// What the controller asks for in a step.
struct Control {
  bool clamp_head = true;
  TipForce tip;
  std::vector<ThigmotaxisCommand> thigmotaxis;  ///< rows of Eq. 6 at any number of contacts
  /// Angles to which the muscles pull the hinges, rad, nv, 0 at the root; empty where they do not.
  Eigen::VectorXd rest_shape;
  ActiveTorque torque;  ///< other torques of the law; empty or 0 where there are none
  ActiveTorque active;  ///< torques towards the rest shape (active_curvature.hpp)
};

/// All that a step depends on, except the warm start.
struct StepInput {
  const Model& model;
  const Scene& scene;
  const State& state;
  const Observation& observation;  ///< observation of `state`
  const Control& control;
};

/// Whether a step keeps momentum: nothing holds the head, and the scene asks for it. It then has no
/// frame of reference, so that all that acts on velocities is for one who moves with the body.
inline bool keeps_momentum(const Scene& scene, bool clamp_head) {
  return scene.time.momentum == FreeMomentum::kept && !clamp_head;
}
inline bool keeps_momentum(const StepInput& in) {
  return keeps_momentum(in.scene, in.control.clamp_head);
}

/// The place where the equations of a step hold, and how the animal moves there. Its references and
/// pointers are into the step's input (start_of) or into the time rule (StepSolver::place). They
/// hold while these live. The rule's next pass or step overwrites what it holds.
struct StepPlace {
  const Kinematics& kin;            ///< pose of Eq. 1 and of the rows
  StepMotion motion;                ///< the step's first velocity there, and the mean one
  const Eigen::VectorXd& velocity;  ///< best estimate of the step's velocity: that of kin, nv
  /// Null at the step's start, where contacts are as found.
  const std::vector<SplineSegment>* segments = nullptr;
};

/// The start of a step, where its equations hold by the paper's rule.
inline StepPlace start_of(const StepInput& in) {
  return {in.observation.kin, motion_of(in.observation.kin), in.state.qdot};
}

}  // namespace hagfish
