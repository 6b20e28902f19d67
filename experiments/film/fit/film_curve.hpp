// A smooth curve through the points of one frame, the bends of a body that lies along it, and the
// motion that brings points nearest to others.
#pragma once

#include <Eigen/Core>

#include "experiments/film/film.hpp"

namespace hagfish {

/// Nodes of a frame's curve, even along the body from head to tail.
inline constexpr Eigen::Index curve_nodes = 41;

/// The curve (3 x curve_nodes) that lies near the frame's points, by least squares with third
/// differences held down: parts without points go on as they bend. `frame` has two points or more.
Eigen::Matrix3Xd curve_through(const FilmFrame& frame);

/// The head's pose and the bends of a body along a curve, without twist.
struct CurveBends {
  Eigen::Matrix3d head;   ///< head to film; its first column runs to the tail
  Eigen::MatrixXd bends;  ///< stations x 2, about Y and Z, rad per body length
};
CurveBends bends_along(const Eigen::Matrix3Xd& curve, Eigen::Index stations);

/// The turn that brings X nearest to `along`, a unit vector: about Z alone where `along` is in the
/// plane of X and Y.
Eigen::Matrix3d turn_to(const Eigen::Vector3d& along);

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
