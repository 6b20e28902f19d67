// What the head's pull at food comes to, from the means between two frames of a log.
#pragma once

#include <array>
#include <limits>

#include "core/log/means/log_means.hpp"

namespace hagfish {

/// All nan where nothing pulls.
struct PullFigures {
  double force = std::numeric_limits<double>::quiet_NaN();  ///< pull of the head at the food, dyn
  double plate = force;                         ///< force of the plate on the knot, along +x, dyn
  std::array<double, 2> bearing{force, force};  ///< y, z of the point at which that acts, cm
  double torque = force;            ///< largest of a hinge, active and thigmotaxis, dyn cm
  double advantage_rows = force;    ///< pull over the sum of λ / h of the rows of Eq. 6
  double advantage_torque = force;  ///< pull over torque, 1/cm
};

/// Figures of a clamped head, which is at the origin and unturned.
PullFigures pull_figures(const FrameMeans& mean);

}  // namespace hagfish
