// The activations that give torques: the inverse problem of muscles.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/muscle/paths.hpp"
#include "solvers/active_set.hpp"

namespace hagfish {

/// How well the muscles can produce a torque.
struct MuscleEffort {
  Eigen::VectorXd activation;  ///< a of each of Model::muscles, 0 to 1
  Eigen::VectorXd residual;    ///< torque - R a F_max, dyn cm, nv; 0 at the root
};

/// w of the problem below is this over |R F_max|^2, the square of what the joint's muscles give at
/// full activation. Strong enough muscles then meet torques to 1e-6 of that, and among activations
/// that meet them 1/2 |a|^2 still decides.
inline constexpr double residual_weight = 1e6;

/// Solves min 1/2 |a|^2 + w |R a F_max - torque|^2 with 0 <= a <= 1, joint by joint, since no
/// muscle crosses two joints. Each is a box QP in the activations. Keeps its storage.
class ActivationSolver {
 public:
  /// The effort for `torque` (nv, dyn cm; its root entries do not matter) in the shape of `kin`.
  /// Throws std::invalid_argument if a torque is not finite, and std::logic_error if the back end
  /// fails.
  void solve(const Model& model, const Kinematics& kin, const Eigen::VectorXd& torque,
             MuscleEffort& effort);

 private:
  struct Joint {
    ActiveSetBoxQp solver;
    BoxQp qp;
    BoxQpSolution solution;
    Eigen::MatrixXd give;  ///< R F_max, hinges x muscles
  };
  std::array<Joint, most_muscles + 1> joints_;  ///< one for each number of muscles
};

}  // namespace hagfish
