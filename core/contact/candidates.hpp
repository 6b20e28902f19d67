// Pairs of segments that may touch. Each search for contacts passes them on to the next, with
// bounds on how far the segments have moved.
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

/// Both ends of each segment: where two segments meet, where the first begins and where the last
/// ends. One row for each.
struct SegmentEnds {
  Eigen::MatrixX3d point;  ///< cm
  Eigen::MatrixX3d third;  ///< a third of the slope there, cm
};

/// The pairs of segments. `pairs`, `clear_until` and `closest` have an entry for each pair.
struct Candidates {
  std::vector<SegmentPair> pairs;  ///< sorted
  /// The pair needs no evaluation until its two segments together have moved this far, cm.
  std::vector<double> clear_until;
  std::vector<std::optional<ClosestPoints>> closest;  ///< answer of the last evaluation
  std::vector<int> first;  ///< index of each segment's first pair; at the end, the number of pairs
  SegmentEnds ends;        ///< ends of the segments of the last search
  std::vector<double> displacement;  ///< bound for each segment since the pairs were listed, cm
  double displacement_of(int pair) const {
    return displacement[pairs[pair].a] + displacement[pairs[pair].b];
  }
};

/// Makes `segments` those of the last search. Motion is measured from there.
void keep_ends(const std::vector<SplineSegment>& segments, Candidates& candidates);

/// Sets `first` for the pairs of this number of segments.
void index_pairs(std::size_t segments, Candidates& candidates);

/// Adds up how far the segments have moved. Once that is too far, lists the pairs again whose
/// bounding spheres are near each other (paper, 3.1).
void update_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                       Candidates& candidates);

/// Lists, in their order, the pairs that have moved far enough since their evaluation to need
/// another one.
void find_pairs_to_evaluate(const Candidates& candidates, std::vector<int>& pairs);

/// The pair of segments a and b, or -1 if they are not a pair.
int find_pair(const Candidates& candidates, int a, int b);

}  // namespace hagfish
