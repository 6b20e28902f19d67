#include "core/contact/candidates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/chain/lanes.hpp"

namespace hagfish {
namespace {

/// Distance between bounding spheres, beyond the margin, up to which pairs are listed, cm: half a
/// radius of the body. It is twice the motion of a segment after which the pairs are listed again.
/// It affects speed alone.
double carried_beyond(const std::vector<SplineSegment>& segments) {
  double thickest = 0;
  for (const SplineSegment& segment : segments) {
    if (segment.obstacle < 0) thickest = std::max(thickest, segment.r0);
  }
  return 0.5 * thickest;
}

/// Visits the ends with their index, point and a third of the slope there.
template <class Visit>
void visit_ends(const std::vector<SplineSegment>& segments, const Visit& visit) {
  constexpr double third = 1.0 / 3;
  const auto n = static_cast<Eigen::Index>(segments.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    visit(k, segments[k].c0, (third * segments[k].c1).eval());
  }
  visit(n, segments.back().point(1), (third * segments.back().slope(1)).eval());
}

/// Adds to candidates.displacement the largest motion of each segment since candidates.ends. Two
/// cubics are no further apart than their Bézier points. These are the ends, and the ends plus or
/// minus a third of the slopes there.
void add_motion(const std::vector<SplineSegment>& segments, Candidates& candidates) {
  SegmentEnds& ends = candidates.ends;
  double behind = 0;  // squared displacement of the Bézier points at the segment's first end
  visit_ends(segments,
             [&](Eigen::Index k, const Eigen::Vector3d& point, const Eigen::Vector3d& third) {
               double end = 0, before = 0, after = 0;
               for (int i = 0; i < 3; ++i) {
                 const double shift = point[i] - ends.point(k, i);
                 const double turned = third[i] - ends.third(k, i);
                 end += shift * shift;
                 before += (shift - turned) * (shift - turned);
                 after += (shift + turned) * (shift + turned);
                 ends.point(k, i) = point[i];
                 ends.third(k, i) = third[i];
               }
               if (k > 0) {
                 candidates.displacement[k - 1] += std::sqrt(std::max({behind, end, before}));
               }
               behind = std::max(end, after);
             });
}

void list_pairs(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                Candidates& candidates) {
  candidates.pairs.clear();
  candidates.clear_until.clear();
  candidates.displacement.assign(segments.size(), 0);
  const double carried = carried_beyond(segments);
  // Slack, so that rounding does not put equal arcs on different sides of the bound.
  const double least_arc = settings.least_arc * (1 - 1e-9);
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n && segments[a].obstacle < 0; ++a) {  // obstacles follow the body
    for (int b = a + 1; b < n; ++b) {
      if (segments[b].s0 - segments[a].arc(1) < least_arc) continue;
      const double reach = segments[a].bound + segments[b].bound + settings.margin;
      const double square = (segments[a].middle - segments[b].middle).squaredNorm();
      if (square <= (reach + carried) * (reach + carried)) {
        candidates.pairs.push_back({a, b});
        candidates.clear_until.push_back(std::sqrt(square) - reach);
      }
    }
  }
  candidates.all_changed = true;
  candidates.closest.assign(candidates.pairs.size(), std::nullopt);
  index_pairs(segments.size(), candidates);
}

/// Whether the segments b of the pairs from `i` on, one pair for each lane, follow each other. For
/// most pairs of one segment a they do.
bool in_line(const Candidates& candidates, int i) {
  return candidates.pairs[i + lane_count - 1].b == candidates.pairs[i].b + lane_count - 1;
}

/// Lists those of the consecutive pairs from `first` on that must be evaluated, one for each lane.
void list_pairs_in_line(const Candidates& candidates, int first, std::vector<int>& pairs) {
  const SegmentPair& pair = candidates.pairs[first];
  const Lanes displacement =
      candidates.displacement[pair.a] + lanes_at(&candidates.displacement[pair.b]);
  const LaneMask clear = displacement < lanes_at(&candidates.clear_until[first]);
  for (unsigned bits = bits_of(~clear); bits != 0; bits &= bits - 1) {
    pairs.push_back(first + std::countr_zero(bits));
  }
}

}  // namespace

void keep_ends(const std::vector<SplineSegment>& segments, Candidates& candidates) {
  SegmentEnds& ends = candidates.ends;
  if (segments.empty()) {
    ends = {};
    return;
  }
  const auto n = static_cast<Eigen::Index>(segments.size());
  ends.point.resize(n + 1, 3);
  ends.third.resize(n + 1, 3);
  visit_ends(segments, [&](Eigen::Index k, const auto& point, const auto& third) {
    ends.point.row(k) = point.transpose();
    ends.third.row(k) = third.transpose();
  });
}

void index_pairs(std::size_t segments, Candidates& candidates) {
  const int count = static_cast<int>(candidates.pairs.size());
  candidates.first.clear();
  int i = 0;
  for (int a = 0; a <= static_cast<int>(segments); ++a) {
    while (i < count && candidates.pairs[i].a < a) ++i;
    candidates.first.push_back(i);
  }
}

void update_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                       Candidates& candidates) {
  if (segments.empty()) {  // a single body
    candidates = {};
    index_pairs(0, candidates);
    return;
  }
  if (candidates.displacement.size() != segments.size()) {
    keep_ends(segments, candidates);
    list_pairs(segments, settings, candidates);
    return;
  }
  add_motion(segments, candidates);
  if (candidates.changed.size() > candidates.pairs.size()) {  // nobody keeps them
    candidates.changed.clear();
    candidates.all_changed = true;
  }
  if (!(std::ranges::max(candidates.displacement) <= 0.5 * carried_beyond(segments))) {
    list_pairs(segments, settings, candidates);
  }
}

void find_pairs_to_evaluate(const Candidates& candidates, std::vector<int>& pairs) {
  pairs.clear();
  for (std::size_t a = 0; a + 1 < candidates.first.size(); ++a) {
    const int end = candidates.first[a + 1];
    for (int i = candidates.first[a]; i < end;) {
      if (i + lane_count <= end && in_line(candidates, i)) {
        list_pairs_in_line(candidates, i, pairs);
        i += lane_count;
      } else {
        if (!(candidates.displacement_of(i) < candidates.clear_until[i])) pairs.push_back(i);
        ++i;
      }
    }
  }
}

void keep_candidates(Candidates& candidates, Candidates& kept) {
  if (candidates.all_changed) {
    kept = candidates;
    for (Candidates* both : {&candidates, &kept}) {
      both->all_changed = false;
      both->changed.clear();
    }
    return;
  }
  kept.ends = candidates.ends;
  kept.displacement = candidates.displacement;
  for (const int i : candidates.changed) {
    kept.clear_until[i] = candidates.clear_until[i];
    kept.closest[i] = candidates.closest[i];
  }
  candidates.changed.clear();
}

int find_pair(const Candidates& candidates, int a, int b) {
  if (a < 0 || a + 1 >= static_cast<int>(candidates.first.size())) {
    return -1;
  }
  // The partners of a segment mostly follow each other.
  const int first = candidates.first[a];
  const int last = candidates.first[a + 1];
  if (first == last || b < candidates.pairs[first].b) {
    return -1;
  }
  int i = std::min(first + b - candidates.pairs[first].b, last - 1);
  while (candidates.pairs[i].b > b) {
    --i;
  }
  return candidates.pairs[i].b == b ? i : -1;
}

}  // namespace hagfish
