// The animal bends itself (addition: the paper pulls the tail's tip): each hinge is pulled towards
// its angle in a rest shape, which a curvature program gives while the knot forms and which muscle
// tone, following the body, keeps afterwards. Rods know it as intrinsic curvature, motor control as
// the equilibrium-point hypothesis.
#pragma once

#include <Eigen/Core>

#include "core/chain/dynamics.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The program's shape at `time` (s), noise and all: the hinges' angles, rad, nv, 0 at the root. A
/// hinge takes the share of the body that it stands for (hinge_span).
void program_shape(const Model& model, const CurvatureProgram& program, double time,
                   Eigen::VectorXd& shape);
Eigen::VectorXd program_shape(const Model& model, const CurvatureProgram& program, double time);

/// Moves `rest` (nv, rad; empty before the first step) to what it is for the step from `time` (s),
/// which begins at coordinates `q` (nq) in `phase`:
///   form              the program's shape where the step's forces act: at its end, by the midpoint
///                     rule in its middle;
///   tighten to reverse  q_ref' = (q - q_ref) / tone_time, so that tone follows the shape;
///   release, free       q_ref' = -q_ref / relax_time, towards straight.
/// The two decays are exact over the step at constant q. A run that begins after form begins with
/// the shape of `q`.
void move_rest_shape(const Model& model, const Scene& scene, Phase phase, const Eigen::VectorXd& q,
                     double time, Eigen::VectorXd& rest);

/// The torques for a step from `state`, with k_a = stiffness / hinge_span of each hinge and k its
/// passive stiffness, which is fed forward since it pulls to straight:
///   u = k_a (q_ref - q - t q̇) + k q_ref,
/// linearly implicit as the passive spring is; t (s) is how far `ahead` the hinges are looked at.
/// Where this, at the velocity of `state`, is beyond the capacity, the torque is the capacity and
/// constant within the step.
void active_torque(const Model& model, const ActiveSettings& active, const State& state,
                   const Eigen::VectorXd& rest, double ahead, ActiveTorque& torque);
/// Those at the step's reach, h or half of it, which the step takes.
ActiveTorque active_torque(const Model& model, const Scene& scene, const State& state,
                           const Eigen::VectorXd& rest);

/// Bounds `torque`, asked for besides `active` (empty where there is none): where both, at the
/// velocity `qdot` (nv) of the step's start, come to more than `capacity` (dyn cm) at a hinge, they
/// are that, and `torque` is constant within the step.
void bound_torque(double capacity, const Eigen::VectorXd& qdot, const ActiveTorque& active,
                  ActiveTorque& torque);

}  // namespace hagfish
