// Obstacles as contact sees them. A plane holds bodies one by one. A strand is a part of the list
// of segments, behind those of the body: what self-contact knows of two strands it knows of the
// body and one that does not move.
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/contact/contact.hpp"

namespace hagfish {

/// Gap of a body's sphere to a plane, cm, negative where it is behind it. `kin` needs positions
/// only.
inline double plane_gap(const Model& model, const Kinematics& kin, const Obstacle& plane,
                        int body) {
  return plane.normal.dot(kin.centre.col(body) - plane.point) - model.bodies[body].radius;
}

/// Calls `visit(obstacle, body, gap)` for each body that a plane holds, plane by plane; the first
/// is the plane's index.
template <class Visit>
void visit_plane_gaps(const Model& model, const Kinematics& kin, Visit visit) {
  for (int k = 0; k < static_cast<int>(model.obstacles.size()); ++k) {
    const Obstacle& plane = model.obstacles[k];
    double arc = 0;
    for (int b = 0; plane.kind == Obstacle::Kind::plane && b < model.body_count(); ++b) {
      const Body& body = model.bodies[b];
      arc += body.length;
      if (arc - 0.5 * body.length >= plane.neck) {
        visit(k, b, plane_gap(model, kin, plane, b));
      }
    }
  }
}

/// Whether there is an obstacle of this index and it is a strand.
bool has_strand(const Model& model, int obstacle);

/// How many segments the curve of a strand has.
int segments_of(const Obstacle& strand);

/// Points along the curve of a strand, 3 x N, cm, for what draws it: with straight lines between
/// them it is off by some 0.1 % of its radius of curvature, where its points turn by 30 degrees.
Eigen::Matrix3Xd strand_curve(const Obstacle& strand);

/// Where the segments of a strand begin in the list of update_segments().
int strand_begin(const Model& model, int obstacle);

/// The parameter of the point of a strand at which `contact` is: counts the strand's segments.
double strand_parameter(const Model& model, const Contact& contact);

/// How many segments the list of update_segments() has.
int segment_count(const Model& model);

/// The segments of the body, as update_spline(), and behind them those of each strand. Before each
/// strand lies one that is no part of anything and near to nothing, so that no two strands share
/// an end.
void update_segments(const Model& model, const Eigen::Matrix3Xd& centre,
                     std::vector<SplineSegment>& segments);

}  // namespace hagfish
