#include "core/contact/candidates.hpp"

#include <algorithm>
#include <cmath>

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
  for (Eigen::Index k = 0; k < n; ++k) visit(k, segments[k].c0, (third * segments[k].c1).eval());
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
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n && segments[a].obstacle < 0; ++a) {  // obstacles follow the body
    for (int b = a + 1; b < n; ++b) {
      if (!settings.may_touch(segments[b].s0 - segments[a].arc(1))) continue;
      const double reach = segments[a].bound + segments[b].bound + settings.margin;
      const double square = (segments[a].middle - segments[b].middle).squaredNorm();
      if (square <= (reach + carried) * (reach + carried)) {
        candidates.pairs.push_back({a, b});
        candidates.clear_until.push_back(std::sqrt(square) - reach);
      }
    }
  }
  candidates.closest.assign(candidates.pairs.size(), std::nullopt);
  index_pairs(segments.size(), candidates);
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
  if (!(std::ranges::max(candidates.displacement) <= 0.5 * carried_beyond(segments))) {
    list_pairs(segments, settings, candidates);
  }
}

void find_pairs_to_evaluate(const Candidates& candidates, std::vector<int>& pairs) {
  pairs.clear();
  for (int i = 0; i < static_cast<int>(candidates.pairs.size()); ++i) {
    if (!(candidates.displacement_of(i) < candidates.clear_until[i])) pairs.push_back(i);
  }
}

int find_pair(const Candidates& candidates, int a, int b) {
  if (a < 0 || a + 1 >= static_cast<int>(candidates.first.size())) return -1;
  // The partners of a segment mostly follow each other.
  const int first = candidates.first[a];
  const int last = candidates.first[a + 1];
  if (first == last || b < candidates.pairs[first].b) return -1;
  int i = std::min(first + b - candidates.pairs[first].b, last - 1);
  while (candidates.pairs[i].b > b) --i;
  return candidates.pairs[i].b == b ? i : -1;
}

}  // namespace hagfish
