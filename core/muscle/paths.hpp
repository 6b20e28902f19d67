// Muscles as paths between bodies: lengths, moment arms, torques.
#pragma once

#include <Eigen/Core>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

/// Most muscles of one joint.
inline constexpr int most_muscles = 4;

/// Muscles of one joint: [first, first + count) of Model::muscles.
struct MuscleGroup {
  int first = 0, count = 0;
};
/// The muscles of the joint whose first muscle is `first`.
MuscleGroup muscle_group(const Model& model, int first);

/// l of a muscle, the sum of the lengths of its lines, cm.
double muscle_length(const Kinematics& kin, const Muscle& muscle);

/// Writes R = -dl/dq at the hinges of its joint into `arm`, cm: dofs of model.bodies[muscle.body].
/// A line of length 0 has no direction and counts as 0.
void moment_arms(const Model& model, const Kinematics& kin, const Muscle& muscle,
                 Eigen::Ref<Eigen::VectorXd> arm);

/// R a F_max of all muscles: nv, dyn cm, 0 at the root. `activation` has one number for
/// each muscle.
void muscle_torque(const Model& model, const Kinematics& kin,
                   const Eigen::Ref<const Eigen::VectorXd>& activation, Eigen::VectorXd& torque);

}  // namespace hagfish
