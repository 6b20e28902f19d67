// Unilateral rows: their right-hand sides, and which of them are near binding.
#pragma once

#include <algorithm>
#include <optional>

#include "core/step/rows/row.hpp"

namespace hagfish {

/// Selects the unilateral rows near binding. Most of the animal's 500 rows are far from it.
struct NearBinding {
  const Eigen::VectorXd& v;  ///< a velocity, nv
  BodyVelocities bodies;     ///< motion of the bodies at it
  double slack;              ///< rows of angles are near where C v - d is below this, rad/s
  double slack_at_rest;      ///< rows with -d below this are near, too: they touch
  double radius = 1;         ///< rows of points: both bounds times this, cm

  bool operator()(double row_velocity, double rhs) const {
    return row_velocity - rhs < slack || -rhs < slack_at_rest;
  }
  bool of_points(double row_velocity, double rhs) const {
    return row_velocity - rhs < radius * slack || -rhs < radius * slack_at_rest;
  }
};

/// The right-hand side of a unilateral row at `gap` (cm or rad); none if the row does not act.
/// Speculative rows let a gap close within the step. A violation is corrected over several steps,
/// at no more than the speed `fastest`.
inline std::optional<double> unilateral(double gap, const ConstraintSettings& settings, double h,
                                        double fastest) {
  if (gap >= 0 && settings.activation == Activation::violated) return std::nullopt;
  return gap >= 0 ? -gap / h : std::min(-settings.baumgarte * gap / h, fastest);
}

}  // namespace hagfish
