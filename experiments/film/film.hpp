// Midlines of an animal as digitised from a film: points along the body through time.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

struct FilmFrame {
  double time = 0;            ///< s
  std::vector<double> place;  ///< of each point, share of the length from the head, 0 to 1, rising
  Eigen::Matrix3Xd point;     ///< cm, in the film's own axes; z is 0 in two dimensions
};

struct Film {
  std::vector<FilmFrame> frames;  ///< times rising
  bool planar = false;            ///< it has no z
  double length = 0;              ///< of the animal: the largest s, or the longest polygon, cm
};

/// Reads a CSV with a heading: `time_s`; `s_cm` (or m, mm, px) or `point`, which rise from head to
/// tail; `x_cm`, `y_cm` and perhaps `z_cm` (or m, mm, px), as `hagfish export` writes midlines.
/// Other columns do not matter. Without s the points are placed by the way along their polygon,
/// which is taken to run from end to end. `pixels_per_cm`: of columns in px; 0 where there are
/// none. Throws InputError, one line, for a column or unit that is missing, for what is no number,
/// for points whose way along the body is not a fifth to five times what s says, and for fewer than
/// two frames or five points in one; FileError where the file cannot be read.
Film read_film(const std::string& file, double pixels_per_cm);

/// The point of the chain at a share of its length from the head, world, cm.
Eigen::Vector3d point_on(const Model& model, const Kinematics& kin, double place);

/// The rigid motion, x to rotation x + shift, that brings `from` (3 x n) nearest to `to`, by least
/// squares.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd of(const Eigen::Matrix3Xd& points) const {
    return (rotation * points).colwise() + shift;
  }
};
RigidMotion nearest_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

}  // namespace hagfish
