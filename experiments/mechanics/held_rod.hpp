// Elastic rods that are held at both ends: at rest where their energy is least among all shapes
// that the ends allow. They give way where the stiffness against some such motion ends.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/mechanics/rod.hpp"

namespace hagfish {

/// The head is clamped. Of the tail end, its place along x, y, z (0 to 2) and its rotation about
/// them (3 to 5) are held as they are at first, where `tail` has them. What is free along x is
/// pulled.
struct RodEnds {
  std::vector<int> tail;
  double tension = 0;      ///< pull along +X, dyn
  std::vector<int> level;  ///< bodies whose frame's z is held at 0, too
};

class HeldRod {
 public:
  HeldRod(RodChain chain, RodEnds ends);
  /// Newton's method for the shape at rest. Returns the largest moment left at a hinge, dyn cm.
  double settle();
  /// Stiffness against the motion that is resisted least of all that the ends allow, dyn cm. The
  /// last `let_go` of the bodies held level may move, under the forces that hold them.
  double least_stiffness(int let_go = 0) const;

 private:
  Kinematics at(const Eigen::VectorXd& angles) const;
  Eigen::Vector3d tail_end(const Kinematics& kin) const;
  Eigen::Vector3d turned(const Kinematics& kin) const;
  Eigen::VectorXd constraint(const Kinematics& kin) const;
  Eigen::VectorXd at_hinges(const Kinematics& kin, const Eigen::Vector3d& force,
                            const Eigen::Vector3d& moment) const;
  Eigen::VectorXd level_row(const Kinematics& kin, int body) const;
  Eigen::MatrixXd jacobian(const Kinematics& kin) const;
  Eigen::VectorXd acting(const Eigen::VectorXd& angles) const;
  Eigen::MatrixXd hessian() const;

  Model model_;
  RodEnds ends_;
  Eigen::VectorXd angles_;       ///< angles of the hinges
  Eigen::VectorXd multipliers_;  ///< multipliers of what is held, dyn and dyn cm
  Eigen::Vector3d place_;        ///< place of the tail end at first
  Eigen::Matrix3d rotation_;     ///< the last body's at first
};

}  // namespace hagfish
