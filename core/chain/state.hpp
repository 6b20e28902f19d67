// What changes: generalised positions and velocities, laid out as MuJoCo's qpos and qvel.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/chain/model.hpp"

namespace hagfish {

struct State {
  /// Root position (cm, world), root orientation (unit quaternion w x y z, body to world), then
  /// hinge angles (rad) head to tail; length nq.
  Eigen::VectorXd q;
  /// Root linear velocity (cm/s, world), root angular velocity (rad/s, body frame), then hinge
  /// rates (rad/s); length nv.
  Eigen::VectorXd qdot;
};

/// Straight along +X from the origin, at rest.
State rest_state(const Model& model);

inline Eigen::Quaterniond root_orientation(const Eigen::VectorXd& q) {
  return {q[3], q[4], q[5], q[6]};
}

/// q0 moved by velocity `qdot` for time h (paper, Eq. 2, with the new velocity: semi-implicit
/// Euler). The orientation turns by the exact rotation of the constant body rate, as MuJoCo's
/// mj_integratePos, and is renormalised.
void advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot, double h, Eigen::VectorXd& q);
Eigen::VectorXd advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot, double h);

}  // namespace hagfish
