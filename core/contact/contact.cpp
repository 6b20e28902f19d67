#include "core/contact/contact.hpp"

#include <algorithm>

namespace hagfish {
namespace {

/// Computes the closest points of the queued pairs; lists those within the margin.
void evaluate(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
              int samples, ContactSearch& search) {
  Candidates& candidates = search.candidates;
  ContactScratch& scratch = search.scratch;
  scratch.queries.resize(scratch.queue.size());
  for (std::size_t k = 0; k < scratch.queue.size(); ++k) {
    const int index = scratch.queue[k];
    ClosestPointsQuery& query = scratch.queries[k];
    query.a = &segments[candidates.pairs[index].a];
    query.b = &segments[candidates.pairs[index].b];
    query.guess = candidates.closest[index];
  }
  scratch.closest_points.answer(samples, scratch.queries);
  for (std::size_t k = 0; k < scratch.queue.size(); ++k) {
    const int index = scratch.queue[k];
    const ClosestPoints& closest = scratch.queries[k].closest;
    candidates.closest[index] = closest;
    candidates.clear_until[index] =
        candidates.displacement_of(index) + closest.gap - settings.margin;
    scratch.known[index] = PairState::evaluated;
    if (closest.gap <= settings.margin) scratch.close.push_back(index);
  }
}

// A minimum on the border of two segments is found from both. The two gaps differ by rounding, less
// than this share of the search margin.
constexpr double same_gap = 1e-8;

/// Which neighbour shares the border that `t` lies on: -1, +1, or 0 inside the segment.
int across(double t) { return t <= 0 ? -1 : (t >= 1 ? 1 : 0); }

/// Visits the pairs that share the border, or the corner, where the closest points of pair `index`
/// lie, until `visit(other)` returns false.
template <class Visit>
void visit_across(const Candidates& candidates, int index, const Visit& visit) {
  const SegmentPair& own = candidates.pairs[index];
  const int step_a = across(candidates.closest[index]->t_a);
  const int step_b = across(candidates.closest[index]->t_b);
  for (const auto& [da, db] : {std::pair(step_a, 0), {0, step_b}, {step_a, step_b}}) {
    const int other = da == 0 && db == 0 ? -1 : find_pair(candidates, own.a + da, own.b + db);
    if (other >= 0 && !visit(other)) return;
  }
}

/// A minimum inside both segments always counts. One on a border counts unless the gap decreases
/// beyond the border, and only for the first of the pairs that find it. Neighbours that this search
/// has not evaluated are ignored. Gaps that differ by less than `same` (cm) count as equal.
bool is_local_minimum(const ContactSearch& search, double same, int index) {
  const std::vector<std::optional<ClosestPoints>>& closest = search.candidates.closest;
  if (search.scratch.known[index] == PairState::beaten) return false;
  bool lowest = true;
  visit_across(search.candidates, index, [&](int other) {
    if (search.scratch.known[other] >= PairState::evaluated) {
      const double lower_by = closest[index]->gap - closest[other]->gap;
      lowest = lowest && lower_by <= same && (lower_by < -same || other > index);
    }
    return lowest;
  });
  return lowest;
}

/// Evaluates the queued pairs, and all neighbours that are needed to decide which pairs within the
/// margin are minima.
void evaluate_with_neighbours(const std::vector<SplineSegment>& segments,
                              const ContactSettings& settings, ContactSearch& search) {
  double slenderest = 0;
  for (const SplineSegment& segment : segments) {
    slenderest = std::max(slenderest, segment.s1 / std::min(segment.r0, segment.r0 + segment.r1));
  }
  const int samples = samples_along(slenderest);
  for (std::size_t seen = 0; !search.scratch.queue.empty();) {
    evaluate(segments, settings, samples, search);
    search.scratch.queue.clear();
    for (; seen < search.scratch.close.size(); ++seen) {
      const int index = search.scratch.close[seen];
      if (!is_local_minimum(search, same_gap * settings.margin, index)) {
        search.scratch.known[index] = PairState::beaten;
        continue;
      }
      visit_across(search.candidates, index, [&](int other) {
        if (search.scratch.known[other] == PairState::unknown) {
          search.scratch.known[other] = PairState::queued;
          search.scratch.queue.push_back(other);
        }
        return true;
      });
    }
  }
}

}  // namespace

Eigen::Vector3d contact_normal(const std::vector<SplineSegment>& segments, const Contact& contact) {
  return (segments[contact.segment_a].point(contact.t_a) -
          segments[contact.segment_b].point(contact.t_b))
      .normalized();
}

Eigen::Vector3d skin_point(const std::vector<SplineSegment>& segments, const Contact& contact) {
  const SplineSegment& a = segments[contact.segment_a];
  const SplineSegment& b = segments[contact.segment_b];
  return 0.5 *
         (a.point(contact.t_a) + b.point(contact.t_b) +
          (b.radius(contact.t_b) - a.radius(contact.t_a)) * contact_normal(segments, contact));
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
  c.obstacle = b.obstacle;
  return c;
}

void find_contacts(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                   double near, ContactSearch& search, ContactSet& set) {
  Candidates& candidates = search.candidates;
  update_candidates(segments, settings, candidates);
  search.scratch.known.assign(candidates.pairs.size(), PairState::unknown);
  search.scratch.close.clear();
  find_pairs_to_evaluate(candidates, search.scratch.queue);
  for (const int index : search.scratch.queue) search.scratch.known[index] = PairState::queued;
  evaluate_with_neighbours(segments, settings, search);
  set.contacts.clear();
  set.on_obstacles.clear();
  set.near_pairs.clear();
  set.least_gap = settings.margin;
  for (const int index : search.scratch.close) {
    const bool minimum = is_local_minimum(search, same_gap * settings.margin, index);
    const ClosestPoints& closest = *candidates.closest[index];
    const double gap = closest.gap;
    set.least_gap = std::min(set.least_gap, gap);
    if (!minimum) candidates.clear_until[index] = candidates.displacement_of(index) + gap - near;
    if (minimum || gap < near) {
      const SegmentPair& pair = candidates.pairs[index];
      const Contact contact = contact_at(segments, pair.a, closest.t_a, pair.b, closest.t_b);
      const bool on_obstacle = contact.obstacle >= 0;
      (!minimum ? set.near_pairs : (on_obstacle ? set.on_obstacles : set.contacts))
          .push_back(contact);
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
