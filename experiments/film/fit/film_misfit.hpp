// How far a film's points are from shapes of a body, and how that changes with what is fitted.
#pragma once

#include <Eigen/Core>

#include "experiments/film/film.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {

/// Head to film: a point x of the model, cm, is at rotation x / scale + shift.
struct FilmPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Turns about the head's axes, then shifts along them; a small step of a pose, in this order: turn
/// about Y and Z, shift along X, Y, Z, turn about X; of a flat animal, turn about Z, shift along X
/// and Y.
FilmPose moved(const FilmPose& pose, const Eigen::VectorXd& step, double scale);

/// rho(r): r^2 up to `far`, from there far^2 (1 + 2 log(r / far)).
double cost_of(double r, double far);

/// Dimensions in which points are compared: 2 for a flat animal.
inline Eigen::Index dimensions(const ProgramShape& shape) { return shape.axes() + 1; }

/// Distances of a frame's points from a shape, dimensions x points, in the head's axes, cm of the
/// model. `scale` is cm of the model in one of the film's lengths.
Eigen::MatrixXd distances(const ProgramShape& shape, const FilmFrame& frame,
                          const Eigen::VectorXd& values, const FilmPose& pose, double scale);

/// Distances of a frame's points, a point after the other, and their rates.
struct Misfit {
  Eigen::Index dimensions = 0;
  Eigen::VectorXd off;
  Eigen::MatrixXd rate;      ///< rates by each value
  Eigen::MatrixXd by_pose;   ///< rates by each part of a step of the pose
  Eigen::VectorXd by_scale;  ///< rates by the logarithm of the scale
};
Misfit misfit(const ProgramShape& shape, const FilmFrame& frame, const Eigen::VectorXd& values,
              const FilmPose& pose, double scale, Eigen::Index pose_size);

/// Multiplies what belongs to a point by the root of its weight, rho'(r) / 2r. Returns the cost.
double weigh(Misfit& misfit, double far);

}  // namespace hagfish
