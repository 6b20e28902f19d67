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

/// Where segments meet, or the first begins or the last ends: one row each.
struct SegmentEnds {
  Eigen::MatrixX3d point;  ///< cm
  Eigen::MatrixX3d third;  ///< a third of the slope there, cm
};

/// The pairs of segments. `pairs`, `clear_until` and `closest` have an entry for each pair.
struct Candidates {
  std::vector<SegmentPair> pairs;  ///< sorted
  /// No evaluation is needed until both segments together have moved this far, cm.
  std::vector<double> clear_until;
  std::vector<std::optional<ClosestPoints>> closest;  ///< of the last evaluation
  std::vector<int> first;  ///< index of each segment's first pair; at the end, the number of pairs
  SegmentEnds ends;        ///< of the segments of the last search
  std::vector<double> displacement;  ///< at most, by each segment since the pairs were listed, cm
  /// Pairs that were evaluated since keep_candidates(); or all have changed.
  std::vector<int> changed;
  bool all_changed = true;

  double displacement_of(int pair) const {
    return displacement[pairs[pair].a] + displacement[pairs[pair].b];
  }
};

/// Makes `segments` those of the last search, from which motion counts.
void keep_ends(const std::vector<SplineSegment>& segments, Candidates& candidates);

/// Finds `first` for the pairs of so many segments.
void index_pairs(std::size_t segments, Candidates& candidates);

/// Adds up how far the segments have moved. Once that is too far, lists anew the pairs whose
/// bounding spheres are near each other (paper, 3.1).
void update_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                       Candidates& candidates);

/// Lists the pairs that may matter where the segments are now, in their order: those that have
/// moved far enough since they were evaluated.
void find_pairs_to_evaluate(const Candidates& candidates, std::vector<int>& pairs);

/// Makes `kept` the same as `candidates`, from what has changed in them since the call before,
/// which must have been with the same `kept`.
void keep_candidates(Candidates& candidates, Candidates& kept);

/// The pair of segments a and b, -1 where they are none.
int find_pair(const Candidates& candidates, int a, int b);

}  // namespace hagfish
