// How MuJoCo's constraint solver is set, and how far from converged that leaves it.
#pragma once

#include <string>
#include <vector>

#include "experiments/benchmarks/start.hpp"

namespace hagfish {

struct MujocoSetting {
  std::string solver;    ///< "pgs", "cg", "newton"
  std::string jacobian;  ///< "dense", "sparse"
  double tolerance = 0;  ///< MuJoCo's default is 1e-8

  /// "newton:dense:1e-08"
  std::string name() const;
  void apply(mjModel& model) const;
};

/// Each solver with either Jacobian, at MuJoCo's default tolerance and at 1e-4.
std::vector<MujocoSetting> mujoco_settings();

/// The worst error of the accelerations q̈ over `steps` steps from `start`: |q̈ - q̈*| over
/// |q̈_free - q̈*|, what constraints change it by, both by kinetic energy, √(q̈' M q̈). q̈* is
/// Newton's, from the same state, with no tolerance and as many iterations as it takes.
double mujoco_residual(const Start& start, const MujocoSetting& setting, int steps);

}  // namespace hagfish
