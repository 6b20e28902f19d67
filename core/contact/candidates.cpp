#include "core/contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
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

/// Adds to candidates.moved how far each segment may have moved since candidates.ends: a cubic
/// stays as close to another as their Bézier points, which are its ends and these plus or minus a
/// third of the slopes there.
void add_motion(const std::vector<SplineSegment>& segments, Candidates& candidates) {
  SegmentEnds& ends = candidates.ends;
  double behind = 0;  // squared displacement of the Bézier points at the segment's first end
  visit_ends(segments,
             [&](Eigen::Index k, const Eigen::Vector3d& point, const Eigen::Vector3d& third) {
               double end = 0, before = 0, after = 0;
               for (int i = 0; i < 3; ++i) {
                 const double moved = point[i] - ends.point(k, i);
                 const double turned = third[i] - ends.third(k, i);
                 end += moved * moved;
                 before += (moved - turned) * (moved - turned);
                 after += (moved + turned) * (moved + turned);
                 ends.point(k, i) = point[i];
                 ends.third(k, i) = third[i];
               }
               if (k > 0) {
                 candidates.moved[k - 1] += std::sqrt(std::max({behind, end, before}));
               }
               behind = std::max(end, after);
             });
}

void list_pairs(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                Candidates& candidates) {
  candidates.pairs.clear();
  candidates.clear_until.clear();
  candidates.moved.assign(segments.size(), 0);
  // Slack, so that rounding does not put equal arcs on different sides of the bound.
  const double least_arc = settings.least_arc * (1 - 1e-9);
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n; ++a) {
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
  candidates.matters_at.assign(candidates.pairs.size(), settings.margin);
  for (std::vector<double>& list : candidates.normal) list.assign(candidates.pairs.size(), 0);
  index_pairs(segments.size(), candidates);
}

/// Of two vectors of which each entry may be a number or lanes.
template <class N, class U>
auto dot(const N& n, const U& u) {
  return n[0] * u[0] + n[1] * u[1] + n[2] * u[2];
}

/// A bound on the gap between the skins of segment `a` and of another, cm, or of as many others as
/// there are lanes: how far two planes across the unit vector `n` from there to `a` are apart, each
/// with one of the skins behind it. A cubic stays between its Bézier points. `b(list)` and
/// `next(list)` are the entries of a list of ends at the beginning and the end of the others.
template <class Real, class Begin, class End>
Real plane_gap(const SegmentEnds& ends, int a, const std::array<Real, 3>& n, const Begin& b,
               const End& next) {
  const auto vector = [](const Eigen::MatrixX3d& rows, const auto& of) {
    return std::array{of(rows.col(0).data()), of(rows.col(1).data()), of(rows.col(2).data())};
  };
  constexpr double third = 1.0 / 3;
  const auto a_begins = [a](const double* list) { return list[a]; };
  const auto a_ends = [a](const double* list) { return list[a + 1]; };
  const double r_a = ends.radius[a];
  const double taper_a = third * (ends.radius[a + 1] - r_a);
  const Real first_a = dot(n, vector(ends.point, a_begins)) - r_a;
  const Real last_a = dot(n, vector(ends.point, a_ends)) - ends.radius[a + 1];
  const Real second_a = first_a + dot(n, vector(ends.third, a_begins)) - taper_a;
  const Real third_a = last_a - dot(n, vector(ends.third, a_ends)) + taper_a;
  const Real r_b = b(ends.radius.data());
  const Real taper_b = third * (next(ends.radius.data()) - r_b);
  const Real first_b = -dot(n, vector(ends.point, b)) - r_b;
  const Real last_b = -dot(n, vector(ends.point, next)) - next(ends.radius.data());
  const Real second_b = first_b - dot(n, vector(ends.third, b)) - taper_b;
  const Real third_b = last_b + dot(n, vector(ends.third, next)) + taper_b;
  return least(least(first_a, second_a), least(third_a, last_a)) +
         least(least(first_b, second_b), least(third_b, last_b));
}

/// How far planes across `n` part pair `i` beyond the gap at which it matters, cm.
double clear_by(const Candidates& candidates, int i, const std::array<double, 3>& n) {
  const auto& [a, b] = candidates.pairs[i];
  return plane_gap(
             candidates.ends, a, n, [b = b](const double* list) { return list[b]; },
             [b = b](const double* list) { return list[b + 1]; }) -
         candidates.matters_at[i];
}

/// Whether planes across the line between the closest points of pair `i`, as they were on the
/// segments last, part it now; puts it off then.
bool parted_anew(const std::vector<SplineSegment>& segments, Candidates& candidates, int i) {
  const auto& [a, b] = candidates.pairs[i];
  const ClosestPoints at = candidates.closest[i].value_or(
      ClosestPoints{0.5, 0.5, std::numeric_limits<double>::infinity()});
  if (at.gap <= candidates.matters_at[i] + bent * segments[a].s1 * segments[a].s1) {
    return false;
  }
  const Eigen::Vector3d n = (segments[a].point(at.t_a) - segments[b].point(at.t_b)).normalized();
  const double clear = clear_by(candidates, i, {n.x(), n.y(), n.z()});
  if (!(clear > 0)) {
    return false;
  }
  for (int k = 0; k < 3; ++k) candidates.normal[k][i] = n[k];
  candidates.changed.push_back(i);
  candidates.clear_until[i] = candidates.moved_by(i) + clear;
  return true;
}

/// Whether pair `i` may matter where the segments are now; puts it off where planes say so.
bool is_due(const std::vector<SplineSegment>& segments, Candidates& candidates, int i) {
  const double moved = candidates.moved_by(i);
  if (moved < candidates.clear_until[i]) {
    return false;
  }
  const auto& [x, y, z] = candidates.normal;
  const double clear = clear_by(candidates, i, {x[i], y[i], z[i]});
  if (clear > 0) {
    candidates.clear_until[i] = moved + clear;
    return false;
  }
  return !parted_anew(segments, candidates, i);
}

/// Whether the pairs from `i` on, as many as there are lanes, are of one segment a and of segments
/// b that follow each other, as most are.
bool in_line(const Candidates& candidates, int i) {
  const SegmentPair& first = candidates.pairs[i];
  const SegmentPair& last = candidates.pairs[i + lane_count - 1];
  return last.a == first.a && last.b == first.b + lane_count - 1;
}

/// is_due for pairs in line from `first` on; lists those from `from` on that are.
void list_due_in_line(const std::vector<SplineSegment>& segments, Candidates& candidates, int first,
                      int from, std::vector<int>& due) {
  const auto& [a, b] = candidates.pairs[first];
  const Lanes moved = candidates.moved[a] + lanes_at(&candidates.moved[b]);
  const Lanes until = lanes_at(&candidates.clear_until[first]);
  const LaneMask far = moved >= until;
  if (!any(far)) {
    return;
  }
  const std::array<Lanes, 3> n{lanes_at(&candidates.normal[0][first]),
                               lanes_at(&candidates.normal[1][first]),
                               lanes_at(&candidates.normal[2][first])};
  LaneMask left = far;
  if (any(far & (dot(n, n) > 0))) {
    const Lanes clear =
        plane_gap(
            candidates.ends, a, n, [&, b = b](const double* list) { return lanes_at(list + b); },
            [&, b = b](const double* list) { return lanes_at(list + b + 1); }) -
        lanes_at(&candidates.matters_at[first]);
    const LaneMask parted = far & (clear > 0);
    const Lanes put_off = parted ? moved + clear : until;
    std::memcpy(&candidates.clear_until[first], &put_off, sizeof put_off);
    left &= ~parted;
  }
  for (unsigned bits = bits_of(left) >> (from - first); bits != 0; bits &= bits - 1) {
    const int i = from + std::countr_zero(bits);
    if (!parted_anew(segments, candidates, i)) due.push_back(i);
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
  ends.radius.resize(n + 1);
  visit_ends(segments, [&](Eigen::Index k, const auto& point, const auto& third) {
    ends.point.row(k) = point.transpose();
    ends.third.row(k) = third.transpose();
    ends.radius[k] = k < n ? segments[k].r0 : segments.back().radius(1);
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
  if (candidates.moved.size() != segments.size()) {
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
  if (candidates.changed.size() > candidates.pairs.size()) {  // nobody keeps them
    candidates.changed.clear();
    candidates.all_changed = true;
  }
  const int n = static_cast<int>(segments.size());
  for (int a = 0; a < n; ++a) {
    const int begin = candidates.first[a];
    const int end = candidates.first[a + 1];
    for (int i = begin; i < end;) {
      const int first = std::min(i, end - lane_count);  // the last ones once more to fill lanes
      if (first >= begin && in_line(candidates, first)) {
        list_due_in_line(segments, candidates, first, i, due);
        i = first + lane_count;
      } else {
        if (is_due(segments, candidates, i)) due.push_back(i);
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
  kept.clear_until = candidates.clear_until;
  kept.ends = candidates.ends;
  kept.moved = candidates.moved;
  for (const int i : candidates.changed) {
    kept.matters_at[i] = candidates.matters_at[i];
    kept.closest[i] = candidates.closest[i];
    for (int k = 0; k < 3; ++k) kept.normal[k][i] = candidates.normal[k][i];
  }
  candidates.changed.clear();
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
