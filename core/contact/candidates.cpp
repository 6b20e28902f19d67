#include "core/contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/chain/lanes.hpp"

namespace hagfish {
namespace {

/// Distance between bounding spheres up to which pairs are carried beyond the margin, cm: twice
/// what a segment may move before they are listed again. Affects speed only.
constexpr double carried = 0.5;

/// Planes are tried between two segments only from a gap on that may let them part them: this
/// (1/cm) times the square of a segment's length, by which two of them bow. Affects speed only.
constexpr double bent = 0.05;

/// The end between segments `end - 1` and `end`.
SegmentEnd end_of(const std::vector<SplineSegment>& segments, std::size_t end) {
  if (end < segments.size()) {
    return {segments[end].c0, segments[end].c1};
  }
  return {segments.back().point(1), segments.back().slope(1)};
}

/// Adds to candidates.moved how far each segment may have moved since candidates.ends: a cubic
/// stays as close to another as their Bézier points, which are its ends and these plus or minus a
/// third of the slopes there.
void add_motion(const std::vector<SplineSegment>& segments, Candidates& candidates) {
  double behind = 0;  // squared displacement of the Bézier points at the segment's first end
  for (std::size_t k = 0; k <= segments.size(); ++k) {
    const SegmentEnd now = end_of(segments, k);
    SegmentEnd& before = candidates.ends[k];
    const Eigen::Vector3d moved = now.point - before.point;
    const Eigen::Vector3d turned = (now.slope - before.slope) / 3;
    const double end = moved.squaredNorm();
    if (k > 0) {
      candidates.moved[k - 1] += std::sqrt(std::max({behind, end, (moved - turned).squaredNorm()}));
    }
    behind = std::max(end, (moved + turned).squaredNorm());
    before = now;
  }
}

void list_pairs(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                Candidates& candidates) {
  const int n = static_cast<int>(segments.size());
  candidates.pairs.clear();
  candidates.clear_until.clear();
  candidates.moved.assign(n, 0);
  // Slack, so that rounding does not put equal arcs on different sides of the bound.
  const double least_arc = settings.least_arc * (1 - 1e-9);
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      const double reach = segments[a].bound + segments[b].bound + settings.margin;
      const double square = (segments[a].middle - segments[b].middle).squaredNorm();
      if (square <= (reach + carried) * (reach + carried) &&
          segments[b].s0 - segments[a].arc(1) >= least_arc) {
        candidates.pairs.push_back({a, b});
        candidates.clear_until.push_back(std::sqrt(square) - reach);
      }
    }
  }
  candidates.seen.assign(candidates.pairs.size(), {std::nullopt, settings.margin});
  index_pairs(segments.size(), candidates);
}

/// The Bézier points of c1 t + c2 t² + c3 t³, between which it stays for t in [0, 1].
std::array<double, 4> bezier(double c1, double c2, double c3) {
  constexpr double third = 1.0 / 3;
  return {0, third * c1, third * (2 * c1 + c2), c1 + c2 + c3};
}

/// A bound on the gap between the skins of two segments from below, cm: how far two planes are
/// apart, across the line between the points t_a and t_b, each with one of the skins behind it.
double least_gap(const SplineSegment& a, const SplineSegment& b, double t_a, double t_b) {
  const Eigen::Vector3d n = (a.point(t_a) - b.point(t_b)).normalized();
  const auto of_a = bezier(n.dot(a.c1) - a.r1, n.dot(a.c2), n.dot(a.c3));
  const auto of_b = bezier(n.dot(b.c1) + b.r1, n.dot(b.c2), n.dot(b.c3));
  return n.dot(a.c0 - b.c0) - a.r0 - b.r0 + std::ranges::min(of_a) - std::ranges::max(of_b);
}

/// Whether so many pairs of one segment as there are lanes, from `i` on, are of segments b that
/// follow each other, as most are, and none has moved as far as it is clear.
bool still_clear(const Candidates& candidates, int i) {
  const auto& [a, b] = candidates.pairs[i];
  if (candidates.pairs[i + lane_count - 1].b != b + lane_count - 1) {
    return false;
  }
  LaneValues moved, until;
  std::copy_n(&candidates.moved[b], lane_count, moved.begin());
  std::copy_n(&candidates.clear_until[i], lane_count, until.begin());
  return !any(lanes_of(candidates.moved[a]) + lanes_of(moved) >= lanes_of(until));
}

/// Whether pair `i` may matter where the segments are now; puts it off where planes say so.
bool is_due(const std::vector<SplineSegment>& segments, Candidates& candidates, int i) {
  const double moved = candidates.moved_by(i);
  if (moved < candidates.clear_until[i]) {
    return false;
  }
  const auto& [a, b] = candidates.pairs[i];
  const LastSeen& seen = candidates.seen[i];
  const ClosestPoints at =
      seen.closest.value_or(ClosestPoints{0.5, 0.5, std::numeric_limits<double>::infinity()});
  if (at.gap <= seen.matters_at + bent * segments[a].s1 * segments[a].s1) {
    return true;
  }
  const double clear = least_gap(segments[a], segments[b], at.t_a, at.t_b) - seen.matters_at;
  if (!(clear > 0)) {
    return true;
  }
  candidates.clear_until[i] = moved + clear;
  return false;
}

}  // namespace

void keep_ends(const std::vector<SplineSegment>& segments, Candidates& candidates) {
  candidates.ends.resize(segments.size() + 1);
  for (std::size_t k = 0; k <= segments.size(); ++k) {
    candidates.ends[k] = end_of(segments, k);
  }
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
  if (candidates.ends.size() != segments.size() + 1) {
    keep_ends(segments, candidates);
    list_pairs(segments, settings, candidates);
    return;
  }
  add_motion(segments, candidates);
  if (!(std::ranges::max(candidates.moved) <= 0.5 * carried)) {
    list_pairs(segments, settings, candidates);
  }
}

void find_due(const std::vector<SplineSegment>& segments, Candidates& candidates,
              std::vector<int>& due) {
  due.clear();
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n; ++a) {
    const int end = candidates.first[a + 1];
    for (int i = candidates.first[a]; i < end;) {
      const int next = std::min(i + lane_count, end);
      if (next - i == lane_count && still_clear(candidates, i)) {
        i = next;
        continue;
      }
      for (; i < next; ++i) {
        if (is_due(segments, candidates, i)) due.push_back(i);
      }
    }
  }
}

int find_pair(const Candidates& candidates, int a, int b) {
  if (a < 0 || a + 1 >= static_cast<int>(candidates.first.size())) {
    return -1;
  }
  // Partners of a segment mostly follow each other.
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
