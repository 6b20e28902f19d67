// Closest points of two spline segments: a safeguarded Newton method on the paper's Eq. 5.
#pragma once

#include <optional>

#include "core/contact/spline.hpp"

namespace hagfish {

struct ClosestPoints {
  double t_a = 0, t_b = 0;  ///< parameters in [0, 1]
  double gap = 0;           ///< |x_a - x_b| - r_a - r_b, cm
};

/// Minimises the gap between the skins, φ(t_a, t_b) = |x_b - x_a| - r(t_a) - r(t_b), over both
/// parameters. With a constant radius its gradient is Eq. 5 over the distance; the taper adds
/// -r'. The gap, not the distance, is what must stay positive, and at its minimum the derivative
/// by q is that of the centreline points alone (envelope theorem), also for parallel strands.
///
/// Newton where the Hessian is positive on the free parameters, else the part of it that always is
/// (Gauss-Newton); steps are cut until the gap falls, parameters stay in [0, 1]. Plain clamped
/// Newton cycles on 7 % of candidate pairs.
/// Starts from samples of both segments, one in each basin that they resolve; where there is only
/// one, a `guess`, such as the answer a step ago, replaces it if its gap is smaller.
ClosestPoints closest_points(const SplineSegment& a, const SplineSegment& b,
                             const std::optional<ClosestPoints>& guess = std::nullopt);

}  // namespace hagfish
