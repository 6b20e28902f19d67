// The motion that brings points nearest to others.
#pragma once

#include <Eigen/Core>

namespace hagfish {

struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd of(const Eigen::Matrix3Xd& points) const {
    return (rotation * points).colwise() + shift;
  }
};

/// x to rotation x + shift, that brings `from` (3 x n) nearest to `to`, by least squares.
RigidMotion nearest_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

}  // namespace hagfish
