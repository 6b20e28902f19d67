// Pairs of segments that may touch, carried from one search for contacts to the next by bounds on
// how far they have moved.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/contact/closest_points.hpp"
#include "core/contact/spline.hpp"

namespace hagfish {

/// Two segments, a before b.
struct SegmentPair {
  int a = 0, b = 0;
};

/// What a pair's last evaluation showed.
struct LastSeen {
  std::optional<ClosestPoints> closest;
  /// Only at gaps up to this need the pair be evaluated again, cm.
  double matters_at = 0;
};

/// Where segments meet, or the first begins or the last ends: a point (cm) and the slope there
/// (cm).
struct SegmentEnd {
  Eigen::Vector3d point, slope;
};

/// The pairs, by index along the first three lists, and the segments that they are of.
struct Candidates {
  std::vector<SegmentPair> pairs;  ///< sorted
  /// Not due until both segments together have moved this far, cm.
  std::vector<double> clear_until;
  std::vector<LastSeen> seen;
  std::vector<int> first;  ///< of each segment, where its pairs begin; at the end, their number
  std::vector<SegmentEnd> ends;  ///< of the segments of the last search, one more than these
  std::vector<double> moved;     ///< at most, by each since the pairs were listed, cm

  double moved_by(int pair) const { return moved[pairs[pair].a] + moved[pairs[pair].b]; }
};

/// Makes `segments` those of the last search, from which motion counts.
void keep_ends(const std::vector<SplineSegment>& segments, Candidates& candidates);

/// Finds `first` for the pairs of so many segments.
void index_pairs(std::size_t segments, Candidates& candidates);

/// Adds up how far the segments have moved; lists the pairs anew, from bounding spheres (paper,
/// 3.1), once that is too far.
void update_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                       Candidates& candidates);

/// Lists the pairs that may matter where the segments are now. Others have not moved far enough
/// since they were evaluated, or the planes across the normal there still keep them apart, which
/// puts them off for as far as that is sure (clear_until).
void find_due(const std::vector<SplineSegment>& segments, Candidates& candidates,
              std::vector<int>& due);

/// The pair of segments a and b, -1 where they are none.
int find_pair(const Candidates& candidates, int a, int b);

}  // namespace hagfish
