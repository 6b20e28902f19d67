// Muscles as paths between bodies: lengths, moment arms, torques.
#pragma once

#include <Eigen/Core>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

/// Of one joint.
inline constexpr int most_muscles = 4;

/// Muscles of one joint: [first, first + count) of Model::muscles.
struct MuscleGroup {
  int first = 0, count = 0;
};
/// The group that begins with muscle `first`.
MuscleGroup muscle_group(const Model& model, int first);

/// l, the sum of the lengths of its lines, cm.
double muscle_length(const Kinematics& kin, const Muscle& muscle);

/// R = -dl/dq at the hinges of its joint, cm: dofs of model.bodies[muscle.body], into `arm`. A line
/// of no length, which has no direction, counts as 0.
void moment_arms(const Model& model, const Kinematics& kin, const Muscle& muscle,
                 Eigen::Ref<Eigen::VectorXd> arm);

/// R a F_max of all muscles: nv, dyn cm, 0 at the root. `activation` has as many numbers as the
/// animal muscles.
void muscle_torque(const Model& model, const Kinematics& kin,
                   const Eigen::Ref<const Eigen::VectorXd>& activation, Eigen::VectorXd& torque);

}  // namespace hagfish
