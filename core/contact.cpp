#include "core/contact.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Distance between bounding spheres up to which pairs are carried beyond the margin, cm: twice
/// what a segment may move before they are found anew. Only speed depends on it.
constexpr double carried = 0.5;

/// The pairs carried still hold all that are within the margin.
bool still_holds(const std::vector<SplineSegment>& segments, const ContactSearch& search) {
  if (search.middle.size() != segments.size()) {
    return false;
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double left = 0.5 * carried - (segments[i].bound - search.bound[i]);
    if (left < 0 || (segments[i].middle - search.middle[i]).squaredNorm() > left * left) {
      return false;
    }
  }
  return true;
}

bool spheres_within(const SplineSegment& a, const SplineSegment& b, double distance) {
  const double reach = a.bound + b.bound + distance;
  return (a.middle - b.middle).squaredNorm() <= reach * reach;
}

void find_candidates(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                     ContactSearch& search) {
  const int n = static_cast<int>(segments.size());
  search.candidates.clear();
  search.middle.resize(n);
  search.bound.resize(n);
  // A hair of slack: equal arcs must not fall on either side of the bound by rounding.
  const double least_arc = settings.least_arc * (1 - 1e-9);
  for (int a = 0; a < n; ++a) {
    search.middle[a] = segments[a].middle;
    search.bound[a] = segments[a].bound;
    for (int b = a + 1; b < n; ++b) {
      if (spheres_within(segments[a], segments[b], settings.margin + carried) &&
          segments[b].s0 - segments[a].arc(1) >= least_arc) {
        search.candidates.emplace_back(a, b);
      }
    }
  }
}

void find_close_pairs(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                      ContactSearch& search) {
  search.close.clear();
  for (const auto& [a, b] : search.candidates) {
    if (spheres_within(segments[a], segments[b], settings.margin)) {
      const ClosestPoints closest = closest_points(segments[a], segments[b]);
      if (closest.gap <= settings.margin) {
        search.close.push_back({a, b, closest});
      }
    }
  }
}

// A minimum on the border of two segments is found from both, with gaps that differ by rounding,
// cm.
constexpr double same_gap = 1e-9;

/// Which neighbour shares the border that `t` lies on: -1, +1, or 0 inside the segment.
int across(double t) { return t <= 0 ? -1 : (t >= 1 ? 1 : 0); }

/// A minimum inside both segments always counts; one on a border counts unless the gap falls on
/// beyond it, and only for the first of the pairs that find it. Pairs come sorted by (a, b).
bool is_local_minimum(const std::vector<SegmentPair>& pairs, std::size_t index) {
  const SegmentPair& own = pairs[index];
  const int step_a = across(own.closest.t_a);
  const int step_b = across(own.closest.t_b);
  for (const auto& [da, db] : {std::pair(step_a, 0), {0, step_b}, {step_a, step_b}}) {
    const std::pair<int, int> wanted(own.a + da, own.b + db);
    const auto it = std::lower_bound(pairs.begin(), pairs.end(), wanted,
                                     [](const SegmentPair& c, const std::pair<int, int>& key) {
                                       return std::pair(c.a, c.b) < key;
                                     });
    if (it == pairs.end() || std::pair(it->a, it->b) != wanted) {
      continue;
    }
    const auto other = static_cast<std::size_t>(it - pairs.begin());
    const double lower_by = own.closest.gap - it->closest.gap;
    if (other != index && (lower_by > same_gap || (lower_by >= -same_gap && other < index))) {
      return false;
    }
  }
  return true;
}

}  // namespace

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
                   ContactSearch& search, ContactSet& set) {
  if (!still_holds(segments, search)) {
    find_candidates(segments, settings, search);
  }
  find_close_pairs(segments, settings, search);
  set.contacts.clear();
  set.others.clear();
  set.least_gap = settings.margin;
  for (std::size_t i = 0; i < search.close.size(); ++i) {
    const SegmentPair& pair = search.close[i];
    set.least_gap = std::min(set.least_gap, pair.closest.gap);
    (is_local_minimum(search.close, i) ? set.contacts : set.others)
        .push_back(contact_at(segments, pair.a, pair.closest.t_a, pair.b, pair.closest.t_b));
  }
  std::sort(set.contacts.begin(), set.contacts.end(), [](const Contact& x, const Contact& y) {
    return std::pair(x.arc_a, x.arc_b) < std::pair(y.arc_a, y.arc_b);
  });
}

ContactSet find_contacts(const std::vector<SplineSegment>& segments,
                         const ContactSettings& settings) {
  ContactSearch search;
  ContactSet set;
  find_contacts(segments, settings, search, set);
  return set;
}

}  // namespace hagfish
