// The uniform Catmull-Rom spline through the body centres, with a radius linear in the parameter:
// the animal's cartilaginous spine (paper, Figure 3a). The weights of a uniform spline depend on
// the parameter alone. So a spline point is a fixed mix of body centres, and its velocity is the
// same mix of their velocities. A centripetal spline would not have this property.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/chain/model.hpp"

namespace hagfish {

/// A spline point as a mix of body centres: x = Σ weight_k centre(first + k), k < count.
struct SplineMix {
  int first = 0;
  int count = 0;
  std::array<double, 4> weight{};
  double parameter = 0;  ///< segment + t: counts bodies from the head
};

/// Segment `i` of n - 1 runs from body centre i (t = 0) to i + 1 (t = 1). Beyond both ends the
/// polygon is continued straight.
SplineMix spline_mix(int segment, double t, int bodies);

/// One segment as a cubic, x(t) = c0 + c1 t + c2 t² + c3 t³, with radius r(t) = r0 + r1 t.
struct SplineSegment {
  Eigen::Vector3d c0, c1, c2, c3;  ///< cm
  double r0 = 0, r1 = 0;           ///< cm
  double s0 = 0, s1 = 0;           ///< arc length from the head at rest, s(t) = s0 + s1 t, cm;
                                   ///< infinite where it is no part of the body
  Eigen::Vector3d middle;          ///< centre of a sphere that holds the skin of the segment, cm
  double bound = 0;                ///< its radius, cm
  int obstacle = -1;               ///< index of its obstacle; -1: the body

  Eigen::Vector3d point(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
  Eigen::Vector3d slope(double t) const { return c1 + t * (2 * c2 + 3 * t * c3); }
  Eigen::Vector3d bend(double t) const { return 2 * c2 + 6 * t * c3; }
  double radius(double t) const { return r0 + t * r1; }
  double arc(double t) const { return s0 + t * s1; }
};

/// Sets the curve of a segment from the second to the third of four points (cm), and the sphere
/// about its skin, from its radius.
void set_curve(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
               const Eigen::Vector3d& p3, SplineSegment& segment);

/// All segments through the columns of `centre` (3 x N, cm) with the bodies' radii.
void update_spline(const Model& model, const Eigen::Matrix3Xd& centre,
                   std::vector<SplineSegment>& segments);
std::vector<SplineSegment> spline(const Model& model, const Eigen::Matrix3Xd& centre);

}  // namespace hagfish
