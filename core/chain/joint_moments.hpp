// What forces do at the joints as vectors. A hinge's torque is the part of the moment about one of
// its axes, and these axes turn with the joint. So torques of hinges differ from joint to joint
// where the moment of the body does not.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/chain/kinematics.hpp"

namespace hagfish {

/// Axes halfway between those of the bodies before and behind each joint, world to axes, N. Of the
/// root they are the head's.
std::vector<Eigen::Matrix3d> axes_of_joints(const Kinematics& kin);

/// Adds the moment about each joint of the forces on all bodies behind it to `moment` (3 x N, dyn
/// cm), in `axes`. `wrench` has a wrench about O for each body, 6 x N.
void add_moments(const Kinematics& kin, const Matrix6Xd& wrench,
                 const std::vector<Eigen::Matrix3d>& axes, Eigen::Matrix3Xd& moment);

/// Adds moments of hinges' torques (nv, dyn cm): a joint's are one vector along its hinges' axes.
void add_hinge_moments(const Model& model, const Kinematics& kin, const Eigen::VectorXd& torque,
                       const std::vector<Eigen::Matrix3d>& axes, Eigen::Matrix3Xd& moment);

/// Curvature and twist of the body at each joint, 3 x N, 1/cm: the joint's turn as a vector in
/// axes_of_joints, over hinge_span. 0 at the root.
Eigen::Matrix3Xd joint_curvature(const Model& model, const Kinematics& kin);

}  // namespace hagfish
