// The gap from one point of a strand to another strand, along the latter.
#pragma once

#include <cmath>

#include "core/contact/spline.hpp"

namespace hagfish {

/// The gap from a point of a segment to the skin of radius r about x, and its rate by the
/// parameter.
struct GapAt {
  Eigen::Vector3d apart;  ///< cm
  double distance, gap, rate;

  GapAt(const SplineSegment& segment, const Eigen::Vector3d& x, double r, double t)
      : apart(segment.point(t) - x),
        distance(apart.norm()),
        gap(distance - segment.radius(t) - r),
        rate(apart.dot(segment.slope(t)) / distance - segment.r1) {}
};

/// Where the gap is least between two points of a segment at which it falls and rises. Newton's
/// method on its rate, with bisection where that leaves the interval.
inline double least_between(const SplineSegment& segment, const Eigen::Vector3d& x, double r,
                            double falls, double rises, double start) {
  constexpr int iteration_limit = 50;
  // After a Newton step below this, in a parameter of [0, 1], the error is its square.
  constexpr double step_tolerance = 1e-6;
  double t = start;
  for (int k = 0; k < iteration_limit; ++k) {
    const GapAt here(segment, x, r, t);
    (here.rate < 0 ? falls : rises) = t;
    const double along = here.rate + segment.r1;
    const double growth =
        segment.slope(t).squaredNorm() - along * along + here.apart.dot(segment.bend(t));
    const double newton = t - here.rate * here.distance / growth;
    const bool within = falls <= newton && newton <= rises;
    const double next = within ? newton : 0.5 * (falls + rises);
    if (!(std::abs(next - t) > step_tolerance)) return next;
    t = next;
  }
  return t;
}

}  // namespace hagfish
