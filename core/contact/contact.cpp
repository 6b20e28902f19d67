#include "core/contact/contact.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Distance between bounding spheres up to which pairs are carried beyond the margin, cm: twice
/// what a segment may move before they are searched again. Affects speed only.
constexpr double carried = 0.5;

/// The end between segments `end - 1` and `end`.
SegmentEnd end_of(const std::vector<SplineSegment>& segments, std::size_t end) {
  if (end < segments.size()) {
    return {segments[end].c0, segments[end].c1};
  }
  return {segments.back().point(1), segments.back().slope(1)};
}

/// Adds to search.moved how far each segment may have moved since search.ends: a cubic stays as
/// close to another as their Bézier points, which are its ends and these plus or minus a third of
/// the slopes there.
void add_motion(const std::vector<SplineSegment>& segments, ContactSearch& search) {
  double behind = 0;  // squared displacement of the Bézier points at the segment's first end
  for (std::size_t k = 0; k <= segments.size(); ++k) {
    const SegmentEnd now = end_of(segments, k);
    SegmentEnd& before = search.ends[k];
    const Eigen::Vector3d moved = now.point - before.point;
    const Eigen::Vector3d turned = (now.slope - before.slope) / 3;
    const double end = moved.squaredNorm();
    if (k > 0) {
      search.moved[k - 1] += std::sqrt(std::max({behind, end, (moved - turned).squaredNorm()}));
    }
    behind = std::max(end, (moved + turned).squaredNorm());
    before = now;
  }
}

void find_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                     ContactSearch& search) {
  const int n = static_cast<int>(segments.size());
  search.candidates.clear();
  search.moved.assign(n, 0);
  // Slack, so that rounding does not put equal arcs on different sides of the bound.
  const double least_arc = settings.least_arc * (1 - 1e-9);
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      const double reach = segments[a].bound + segments[b].bound + settings.margin;
      const double square = (segments[a].middle - segments[b].middle).squaredNorm();
      if (square <= (reach + carried) * (reach + carried) &&
          segments[b].s0 - segments[a].arc(1) >= least_arc) {
        search.candidates.push_back({a, b, std::nullopt, std::sqrt(square) - reach});
      }
    }
  }
}

/// Adds up how far the segments have moved; searches the candidates again once that is too far.
void update_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                       ContactSearch& search) {
  if (search.ends.size() != segments.size() + 1) {
    keep_ends(segments, search);
    find_candidates(segments, settings, search);
    return;
  }
  add_motion(segments, search);
  if (!(std::ranges::max(search.moved) <= 0.5 * carried)) {
    find_candidates(segments, settings, search);
  }
}

/// Computes the closest points of the candidates that are due; lists those within the margin.
void evaluate(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
              int samples, ContactSearch& search) {
  search.scratch.queries.resize(search.scratch.due.size());
  for (std::size_t k = 0; k < search.scratch.due.size(); ++k) {
    const SegmentPair& pair = search.candidates[search.scratch.due[k]];
    ClosestPointsQuery& query = search.scratch.queries[k];
    query.a = &segments[pair.a];
    query.b = &segments[pair.b];
    query.guess = pair.closest;
  }
  search.scratch.closest_points.answer(samples, search.scratch.queries);
  for (std::size_t k = 0; k < search.scratch.due.size(); ++k) {
    const int index = search.scratch.due[k];
    SegmentPair& pair = search.candidates[index];
    pair.closest = search.scratch.queries[k].closest;
    search.scratch.known[index] = CandidateState::evaluated;
    pair.clear_until = search.moved_by(pair) + pair.closest->gap - settings.margin;
    if (pair.closest->gap <= settings.margin) {
      search.scratch.close.push_back(index);
    }
  }
}

/// The candidate of two segments, -1 where they are none.
int find_candidate(const ContactSearch& search, int a, int b) {
  if (a < 0 || a + 1 >= static_cast<int>(search.scratch.first.size())) {
    return -1;
  }
  // Partners of a segment mostly follow each other.
  const auto first = search.candidates.begin() + search.scratch.first[a];
  const auto last = search.candidates.begin() + search.scratch.first[a + 1];
  auto it = first == last || b < first->b
                ? last
                : first + std::min<std::ptrdiff_t>(b - first->b, last - first - 1);
  while (it != last && it->b > b) {
    --it;
  }
  return it != last && it->b == b ? static_cast<int>(it - search.candidates.begin()) : -1;
}

// A minimum on the border of two segments is found from both, with gaps that differ by rounding,
// cm.
constexpr double same_gap = 1e-9;

/// Which neighbour shares the border that `t` lies on: -1, +1, or 0 inside the segment.
int across(double t) { return t <= 0 ? -1 : (t >= 1 ? 1 : 0); }

/// Visits the candidates that share the border, or the corner, where the closest points of one lie,
/// until `visit(other)` returns false.
template <class Visit>
void visit_across(const ContactSearch& search, const SegmentPair& own, Visit visit) {
  const int step_a = across(own.closest->t_a);
  const int step_b = across(own.closest->t_b);
  for (const auto& [da, db] : {std::pair(step_a, 0), {0, step_b}, {step_a, step_b}}) {
    const int other = da == 0 && db == 0 ? -1 : find_candidate(search, own.a + da, own.b + db);
    if (other >= 0 && !visit(other)) {
      return;
    }
  }
}

/// A minimum inside both segments always counts; one on a border counts unless the gap decreases
/// beyond it, and only for the first of the pairs that find it. Neighbours that this search has not
/// evaluated are left out.
bool is_local_minimum(const ContactSearch& search, int index) {
  const SegmentPair& own = search.candidates[index];
  bool lowest = search.scratch.known[index] != CandidateState::beaten;
  visit_across(search, own, [&](int other) {
    if (search.scratch.known[other] >= CandidateState::evaluated) {
      const double lower_by = own.closest->gap - search.candidates[other].closest->gap;
      lowest = lowest && lower_by <= same_gap && (lower_by < -same_gap || other > index);
    }
    return lowest;
  });
  return lowest;
}

/// Evaluates the candidates that are due, and all neighbours that it takes to tell which of those
/// within the margin are minima.
void evaluate_with_neighbours(const std::vector<SplineSegment>& segments,
                              const ContactSettings& settings, ContactSearch& search) {
  double longest = 0;
  for (const SplineSegment& segment : segments) {
    longest = std::max(longest, segment.s1);
  }
  const int samples = samples_along(longest);
  for (std::size_t seen = 0; !search.scratch.due.empty();) {
    evaluate(segments, settings, samples, search);
    search.scratch.due.clear();
    for (; seen < search.scratch.close.size(); ++seen) {
      const int index = search.scratch.close[seen];
      if (!is_local_minimum(search, index)) {
        search.scratch.known[index] = CandidateState::beaten;
        continue;
      }
      visit_across(search, search.candidates[index], [&](int other) {
        if (search.scratch.known[other] == CandidateState::unknown) {
          search.scratch.known[other] = CandidateState::due;
          search.scratch.due.push_back(other);
        }
        return true;
      });
    }
  }
}

}  // namespace

void keep_ends(const std::vector<SplineSegment>& segments, ContactSearch& search) {
  search.ends.resize(segments.size() + 1);
  for (std::size_t k = 0; k <= segments.size(); ++k) {
    search.ends[k] = end_of(segments, k);
  }
}

Contact contact_at(const std::vector<SplineSegment>& segments, int segment_a, double t_a,
                   int segment_b, double t_b) {
  const SplineSegment& a = segments[segment_a];
  const SplineSegment& b = segments[segment_b];
  const Eigen::Vector3d apart = a.point(t_a) - b.point(t_b);
  Contact c;
  c.segment_a = segment_a;
  c.segment_b = segment_b;
  c.t_a = t_a;
  c.t_b = t_b;
  c.arc_a = a.arc(t_a);
  c.arc_b = b.arc(t_b);
  c.gap = apart.norm() - a.radius(t_a) - b.radius(t_b);
  c.normal = apart.normalized();
  c.tangent_a = a.slope(t_a).normalized();
  c.tangent_b = b.slope(t_b).normalized();
  return c;
}

void find_contacts(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                   double near, ContactSearch& search, ContactSet& set) {
  update_candidates(segments, settings, search);
  ContactScratch& scratch = search.scratch;
  scratch.known.assign(search.candidates.size(), CandidateState::unknown);
  scratch.close.clear();
  scratch.due.clear();
  scratch.first.resize(segments.size() + 1);
  int a = 0;
  for (std::size_t i = 0; i < search.candidates.size(); ++i) {
    const SegmentPair& pair = search.candidates[i];
    for (; a <= pair.a; ++a) {
      scratch.first[a] = static_cast<int>(i);
    }
    if (search.moved_by(pair) >= pair.clear_until) {
      scratch.known[i] = CandidateState::due;
      scratch.due.push_back(static_cast<int>(i));
    }
  }
  std::fill(scratch.first.begin() + a, scratch.first.end(),
            static_cast<int>(search.candidates.size()));
  evaluate_with_neighbours(segments, settings, search);
  set.contacts.clear();
  set.others.clear();
  set.least_gap = settings.margin;
  for (const int index : search.scratch.close) {
    const bool minimum = is_local_minimum(search, index);
    SegmentPair& pair = search.candidates[index];
    const double gap = pair.closest->gap;
    set.least_gap = std::min(set.least_gap, gap);
    if (!minimum) {
      pair.clear_until = search.moved_by(pair) + gap - near;
    }
    if (minimum || gap < near) {
      (minimum ? set.contacts : set.others)
          .push_back(contact_at(segments, pair.a, pair.closest->t_a, pair.b, pair.closest->t_b));
    }
  }
  std::sort(set.contacts.begin(), set.contacts.end(), [](const Contact& x, const Contact& y) {
    return std::pair(x.arc_a, x.arc_b) < std::pair(y.arc_a, y.arc_b);
  });
}

ContactSet find_contacts(const std::vector<SplineSegment>& segments,
                         const ContactSettings& settings) {
  ContactSearch search;
  ContactSet set;
  find_contacts(segments, settings, 0, search, set);
  return set;
}

}  // namespace hagfish
