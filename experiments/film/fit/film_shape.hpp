// Shapes that a curvature program can give a body at one time: where their points are, and how
// these move with the program's values.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"

namespace hagfish {

/// The point of the chain at a share of its length from the head, world, cm.
Eigen::Vector3d point_on(const Model& model, const Kinematics& kin, double place);

/// Values are bend_y of all stations, then bend_z, rad per body length; of a flat animal, which
/// stays in the plane z = 0, bend_z alone. The head is at the origin and looks along -X. Twist is
/// 0.
class ProgramShape {
 public:
  /// `model` must outlive this.
  ProgramShape(const Model& model, const std::vector<double>& stations, bool flat);

  /// The points (3 x n, cm) at `place` (n, rising, 0 to 1, shares of the length).
  Eigen::Matrix3Xd points(const Eigen::VectorXd& values, const std::vector<double>& place) const;
  /// These points, and their rates by each value, 3n x values, a point after the other, cm per rad
  /// per body length.
  Eigen::Matrix3Xd points(const Eigen::VectorXd& values, const std::vector<double>& place,
                          Eigen::MatrixXd& rate) const;

  Eigen::Index values() const { return axes_ * stations_; }
  Eigen::Index stations() const { return stations_; }
  Eigen::Index axes() const { return axes_; }
  const Model& model() const { return model_; }

 private:
  void place_bodies(const Eigen::VectorXd& values, Kinematics& kin) const;

  const Model& model_;
  Eigen::Index stations_, axes_;
  Eigen::MatrixXd shares_;  // shares of each value (columns) that each velocity (rows) takes
  /// The values of which a velocity takes a share.
  struct Part {
    Eigen::Index value = 0;
    double share = 0;
  };
  std::vector<std::vector<Part>> parts_;  // parts of each velocity
};

}  // namespace hagfish
