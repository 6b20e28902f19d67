// Means over the steps from one frame of the log to the next. A step's force is an impulse over h,
// and rows switch on and off many times a second: a single step does not represent the time around
// it.
#pragma once

#include <array>
#include <cmath>

#include "core/log/means/thigmotaxis_rows.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Means over the steps since the frame before; nan at the first frame, which has none before it.
struct FrameMeans {
  ConstraintForces force;              ///< Σ impulse / elapsed time, by kind, nv each
  Eigen::VectorXd active_torque;       ///< mean of StepSolution::active_torque, nv
  Eigen::VectorXd net_force;           ///< mean of StepSolution::net_force, nv
  std::array<double, 4> lambda;        ///< mean over h, dyn; a step without the row counts as 0
  std::array<double, 4> speed, slack;  ///< mean over steps with the row, cm/s; nan if none has it
  double sum_of_rows;                  ///< sum of the multipliers of all rows over h, dyn
  bool pulls = false;                  ///< the first step is of the phase `pull`
};

/// Accumulates FrameMeans. Storage is kept: after the first frame nothing is allocated.
class RunningMeans {
 public:
  /// `nv`: number of velocities.
  explicit RunningMeans(Eigen::Index nv);
  void take(const StepRecord& record, const ThigmotaxisRows& rows);
  /// Means of all steps since the last call; then starts over.
  const FrameMeans& close();

 private:
  void clear();
  FrameMeans sum_, mean_;
  int steps_ = 0;
  std::array<int, 4> with_row_{};
};

/// What the head's pull at food comes to, from the means between two frames. All nan where nothing
/// pulls.
struct PullFigures {
  double force = NAN;                           ///< pull of the head at the food, dyn
  double plate = force;                         ///< force of the plate on the knot, along +x, dyn
  std::array<double, 2> bearing{force, force};  ///< y, z of the point at which that acts, cm
  double torque = force;            ///< largest of a hinge, active and thigmotaxis, dyn cm
  double advantage_rows = force;    ///< pull over the sum of λ / h of the rows of Eq. 6
  double advantage_torque = force;  ///< pull over torque, 1/cm
};

/// Figures of a clamped head, which is at the origin and unturned.
PullFigures pull_figures(const FrameMeans& mean);

}  // namespace hagfish
