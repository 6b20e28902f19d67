// Obstacles in the search for contacts. A plane holds bodies one by one. A strand adds segments
// behind those of the body, so that the code of self-contact treats it as another strand that does
// not move.
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/contact/contact.hpp"

namespace hagfish {

/// Gap of a body's sphere to a plane, cm; negative where the sphere is behind the plane. `kin`
/// needs positions only.
inline double plane_gap(const Model& model, const Kinematics& kin, const Plane& plane, int body) {
  return plane.normal.dot(kin.centre.col(body) - plane.point) - model.bodies[body].radius;
}

/// A body that a plane holds.
struct PlaneGap {
  int obstacle;  ///< index of the plane
  const Plane& plane;
  int body;
  double gap;  ///< cm
};

/// Calls `visit(PlaneGap)` for each body that a plane holds, plane by plane.
template <class Visit>
void visit_plane_gaps(const Model& model, const Kinematics& kin, Visit visit) {
  for (int k = 0; k < static_cast<int>(model.obstacles.size()); ++k) {
    const Plane* plane = model.obstacles[k].plane();
    double arc = 0;
    for (int b = 0; plane != nullptr && b < model.body_count(); ++b) {
      const Body& body = model.bodies[b];
      arc += body.length;
      if (arc - 0.5 * body.length >= plane->neck) {
        visit(PlaneGap{k, *plane, b, plane_gap(model, kin, *plane, b)});
      }
    }
  }
}

/// Number of segments of a strand's curve.
int segments_of(const Strand& strand);

/// Points along the curve of a strand for drawing, 3 x N, cm. Straight lines between them are off
/// by about 0.1 % of the radius of curvature where the strand's points turn by 30 degrees.
Eigen::Matrix3Xd strand_curve(const Strand& strand);

/// Index of a strand's first segment in the list of update_segments().
int strand_begin(const Model& model, int obstacle);

/// The strand's parameter at `contact`, which counts the strand's segments.
double strand_parameter(const Model& model, const Contact& contact);

/// Writes the segments of the body, as update_spline() does, and behind them those of each strand.
/// A far-away dummy segment lies before each strand, so that no two strands share an end.
void update_segments(const Model& model, const Eigen::Matrix3Xd& centre,
                     std::vector<SplineSegment>& segments);

}  // namespace hagfish
