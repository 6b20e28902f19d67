// Muscles as paths between bodies (addition: the paper has torques, and closes with the wish for
// contractile fibres): lengths, moment arms, torques.
//
// A bending joint has four lines along the body, a pair of antagonists for each of its hinges; a
// twisting joint has two families of oblique lines around the body, one wound like a right-handed
// screw and one like a left-handed one. Both lie at a share of the skin's measured radius.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

/// Those of the chain `model` by what the specimen has (Specimen::muscle), joint by joint from the
/// head; at a bending joint left, right, dorsal, ventral, at a twisting one right_handed,
/// left_handed. The animal's left is -y, its back is +z.
std::vector<Muscle> muscles_of(const Specimen& specimen, const Model& model);

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
