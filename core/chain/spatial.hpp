// Spatial vectors in world axes about one reference point O that all bodies share within a step, so
// that twists and wrenches of different bodies add without transforms. A twist is [angular velocity
// (rad/s); velocity of the body's material at O (cm/s)], a wrench [moment about O (dyn cm); force
// (dyn)]. Notation of Featherstone, "Rigid Body Dynamics Algorithms" (2008), ch. 2.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hagfish {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Wrench of `force` acting at `offset`, taken from O.
inline Vector6d wrench_of_force(const Eigen::Vector3d& force, const Eigen::Vector3d& offset) {
  Vector6d w;
  w << offset.cross(force), force;
  return w;
}

/// Velocity of the material point at `offset`, taken from O, of a body that moves with `twist`.
template <class Twist>
Eigen::Vector3d point_velocity(const Twist& twist, const Eigen::Vector3d& offset) {
  const Eigen::Vector3d spin = twist.template head<3>();
  return twist.template tail<3>() + spin.cross(offset);
}

/// Symmetric operator on twists of a symmetric 3 x 3 pair acting at `offset` from O: `angular` on
/// the angular velocity and `linear` on the velocity of the point there. The inertia of a body at
/// its centre (angular = I_c, linear = m 1) and linear drag have this form.
inline Matrix6d point_operator(const Eigen::Matrix3d& angular, const Eigen::Matrix3d& linear,
                               const Eigen::Vector3d& offset) {
  Eigen::Matrix3d moment;  // [offset] linear
  for (int i = 0; i < 3; ++i) moment.col(i) = offset.cross(linear.col(i));
  Matrix6d m;
  for (int i = 0; i < 3; ++i) {  // angular + moment [offset]'
    m.block<1, 3>(i, 0) = angular.row(i) + offset.cross(moment.row(i).transpose()).transpose();
  }
  m.topRightCorner<3, 3>() = moment;
  m.bottomLeftCorner<3, 3>() = moment.transpose();
  m.bottomRightCorner<3, 3>() = linear;
  return m;
}

}  // namespace hagfish
