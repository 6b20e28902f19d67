#include "core/contact/obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// A ball is a tube about a curve whose length is this share of its radius. A curve without length
/// would have no direction.
constexpr double ball_length = 1e-7;

int point_count(const Strand& strand) { return static_cast<int>(strand.points.size()); }

/// Point `i` of a strand, cm. Beyond the ends of an open strand the polygon is continued straight.
Eigen::Vector3d point_of(const Strand& strand, int i) {
  const std::vector<Eigen::Vector3d>& p = strand.points;
  const int n = point_count(strand);
  if (n == 1) return p[0] + i * ball_length * strand.radius * Eigen::Vector3d::UnitX();
  if (strand.closed) return p[(i + n) % n];
  if (i < 0) return 2 * p[0] - p[1];
  return i < n ? p[i] : (2 * p[n - 1] - p[n - 2]).eval();
}

SplineSegment segment_of(const Strand& strand, int i) {
  SplineSegment s;
  s.r0 = strand.radius;
  s.s0 = INFINITY;
  s.s1 = (point_of(strand, i + 1) - point_of(strand, i)).norm();
  set_curve(point_of(strand, i - 1), point_of(strand, i), point_of(strand, i + 1),
            point_of(strand, i + 2), s);
  return s;
}

/// The dummy segment between two strands. Its first end is the last end of the segment before it,
/// since SegmentEnds gives that segment's motion.
SplineSegment gap_behind(const SplineSegment& before, int obstacle) {
  SplineSegment s;
  s.c0 = before.point(1);
  s.c1 = before.slope(1);
  s.c2 = s.c3 = Eigen::Vector3d::Zero();
  s.r0 = before.radius(1);
  s.s0 = INFINITY;
  s.middle = s.c0;
  s.bound = NAN;  // no comparison of a distance with it is true
  s.obstacle = obstacle;
  return s;
}

}  // namespace

int segments_of(const Strand& strand) {
  const int n = point_count(strand);
  return strand.closed || n == 1 ? n : n - 1;
}

Eigen::Matrix3Xd strand_curve(const Strand& strand) {
  constexpr int pieces = 6;  // of a segment
  const int count = segments_of(strand);
  Eigen::Matrix3Xd curve(3, pieces * count + 1);
  for (int k = 0; k < curve.cols(); ++k) {
    const int i = std::min(k / pieces, count - 1);
    curve.col(k) = segment_of(strand, i).point(static_cast<double>(k - i * pieces) / pieces);
  }
  return curve;
}

int strand_begin(const Model& model, int obstacle) {
  int at = model.body_count() - 1;
  for (int k = 0; k <= obstacle; ++k) {
    const Strand* strand = model.obstacles[k].strand();
    if (strand != nullptr) at += 1 + (k < obstacle ? segments_of(*strand) : 0);
  }
  return at;
}

double strand_parameter(const Model& model, const Contact& contact) {
  return contact.segment_b - strand_begin(model, contact.obstacle) + contact.t_b;
}

void update_segments(const Model& model, const Eigen::Matrix3Xd& centre,
                     std::vector<SplineSegment>& segments) {
  update_spline(model, centre, segments);
  if (segments.empty()) return;  // a single body has no skin between bodies
  for (int k = 0; k < static_cast<int>(model.obstacles.size()); ++k) {
    const Strand* strand = model.obstacles[k].strand();
    if (strand == nullptr) continue;
    segments.push_back(gap_behind(segments.back(), k));
    for (int i = 0; i < segments_of(*strand); ++i) {
      segments.push_back(segment_of(*strand, i));
      segments.back().obstacle = k;
    }
  }
}

}  // namespace hagfish
