// The animal bends itself (addition: in the paper a force pulls the tail's tip). Muscles pull each
// hinge towards its angle in a rest shape. While the knot forms, a curvature program gives this
// shape. Afterwards the rest shape follows the body (tone). For rods this is intrinsic curvature;
// in motor control it is the equilibrium-point hypothesis.
#pragma once

#include <Eigen/Core>

#include "core/chain/dynamics.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The program's shape at `time` (s), including noise: the angles of the hinges, rad, nv, 0 at the
/// root. A hinge takes the bend of the part of the body that it stands for (hinge_span).
void program_shape(const Model& model, const CurvatureProgram& program, double time,
                   Eigen::VectorXd& shape);
Eigen::VectorXd program_shape(const Model& model, const CurvatureProgram& program, double time);

/// Updates `rest` (nv, rad; empty before the first step) for the step from `time` (s), which begins
/// at coordinates `q` (nq) in `phase`:
///   form              the program's shape when the step's forces act: at the end of the step, or
///                     by the midpoint rule in its middle;
///   tighten to reverse  q_ref' = (q - q_ref) / tone_time, so that tone follows the shape;
///   release, free       q_ref' = -q_ref / relax_time, towards straight.
/// The two decays are exact over the step at constant q. A run that begins after form begins with
/// the shape of `q`.
void move_rest_shape(const Model& model, const Scene& scene, Phase phase, const Eigen::VectorXd& q,
                     double time, Eigen::VectorXd& rest);

/// The torques for a step from `state`. k_a = stiffness / hinge_span is that of each hinge, and k
/// its passive stiffness. The passive spring pulls to straight, so the torque compensates it:
///   u = k_a (q_ref - q - t q̇) + k q_ref,
/// It is linearly implicit, as the passive spring is; `ahead` is t (s). Where the torque at the
/// velocity of `state` exceeds the capacity, it is the capacity and constant within the step.
void active_torque(const Model& model, const ActiveSettings& active, const State& state,
                   const Eigen::VectorXd& rest, double ahead, ActiveTorque& torque);
/// Those torques at the step's reach (h or half of it), for use in the step.
ActiveTorque active_torque(const Model& model, const Scene& scene, const State& state,
                           const Eigen::VectorXd& rest);

/// Bounds `torque`, which acts besides `active` (empty where there is none). If both together
/// exceed `capacity` (dyn cm) at a hinge, at the velocity `qdot` (nv) of the step's start, their
/// sum becomes the capacity, and `torque` is constant within the step.
void bound_torque(double capacity, const Eigen::VectorXd& qdot, const ActiveTorque& active,
                  ActiveTorque& torque);

}  // namespace hagfish
