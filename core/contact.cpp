#include "core/contact.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

struct Candidate {
  int a = 0, b = 0;
  ClosestPoints closest;
};

std::vector<Candidate> close_pairs(const Model& model, const std::vector<SplineSegment>& segments,
                                   const ContactSettings& settings) {
  const int n = static_cast<int>(segments.size());
  std::vector<double> arc(n + 1);  // of the segments' ends
  for (int i = 0; i <= n; ++i) {
    arc[i] = i < n ? arc_length(model, i, 0) : arc_length(model, i - 1, 1);
  }
  std::vector<Candidate> pairs;
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      // A hair of slack: equal arcs must not fall on either side of the bound by rounding.
      if (arc[b] - arc[a + 1] < settings.least_arc * (1 - 1e-9)) {
        continue;
      }
      const double reach = segments[a].bound + segments[b].bound + settings.margin;
      if ((segments[a].middle - segments[b].middle).squaredNorm() > reach * reach) {
        continue;
      }
      const ClosestPoints closest = closest_points(segments[a], segments[b]);
      if (closest.gap <= settings.margin) {
        pairs.push_back({a, b, closest});
      }
    }
  }
  return pairs;
}

// A minimum on the border of two segments is found from both, with gaps that differ by rounding,
// cm.
constexpr double same_gap = 1e-9;

/// Which neighbour shares the border that `t` lies on: -1, +1, or 0 inside the segment.
int across(double t) { return t <= 0 ? -1 : (t >= 1 ? 1 : 0); }

/// A minimum inside both segments always counts; one on a border counts unless the gap falls on
/// beyond it, and only for the first of the pairs that find it. Pairs come sorted by (a, b).
bool is_local_minimum(const std::vector<Candidate>& pairs, std::size_t index) {
  const Candidate& own = pairs[index];
  const int step_a = across(own.closest.t_a);
  const int step_b = across(own.closest.t_b);
  for (const auto& [da, db] : {std::pair(step_a, 0), {0, step_b}, {step_a, step_b}}) {
    const std::pair<int, int> wanted(own.a + da, own.b + db);
    const auto it = std::lower_bound(pairs.begin(), pairs.end(), wanted,
                                     [](const Candidate& c, const std::pair<int, int>& key) {
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

Contact contact_at(const Model& model, const std::vector<SplineSegment>& segments, int segment_a,
                   double t_a, int segment_b, double t_b) {
  const SplineSegment& a = segments[segment_a];
  const SplineSegment& b = segments[segment_b];
  const Eigen::Vector3d apart = a.point(t_a) - b.point(t_b);
  Contact c;
  c.segment_a = segment_a;
  c.segment_b = segment_b;
  c.t_a = t_a;
  c.t_b = t_b;
  c.arc_a = arc_length(model, segment_a, t_a);
  c.arc_b = arc_length(model, segment_b, t_b);
  c.gap = apart.norm() - a.radius(t_a) - b.radius(t_b);
  c.normal = apart.normalized();
  c.tangent_a = a.slope(t_a).normalized();
  c.tangent_b = b.slope(t_b).normalized();
  return c;
}

ContactSet find_contacts(const Model& model, const std::vector<SplineSegment>& segments,
                         const ContactSettings& settings) {
  const std::vector<Candidate> pairs = close_pairs(model, segments, settings);
  ContactSet set;
  set.least_gap = settings.margin;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    set.least_gap = std::min(set.least_gap, pairs[i].closest.gap);
    const Candidate& pair = pairs[i];
    (is_local_minimum(pairs, i) ? set.contacts : set.others)
        .push_back(contact_at(model, segments, pair.a, pair.closest.t_a, pair.b, pair.closest.t_b));
  }
  std::sort(set.contacts.begin(), set.contacts.end(), [](const Contact& x, const Contact& y) {
    return std::pair(x.arc_a, x.arc_b) < std::pair(y.arc_a, y.arc_b);
  });
  return set;
}

}  // namespace hagfish
