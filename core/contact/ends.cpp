#include "core/contact/ends.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/gap_at.hpp"

namespace hagfish {
namespace {

constexpr int iteration_limit = 50;
// After a Newton step below this, in a parameter of [0, 1], the error is its square.
constexpr double step_tolerance = 1e-6;

/// The point of the other strand nearest to a point of the first.
struct Nearest {
  double gap = 0;    ///< cm; if there is none, above all that are looked for
  int segment = -1;  ///< -1: there is none
  double t = 0;
  double rate = NAN;  ///< of the gap by the first strand's parameter, cm
};

/// The gaps, and their rates, from four points of a segment to the skin of radius r about x, one in
/// each lane. The points are evenly spaced from the start to the end of the segment.
struct FourGaps {
  static constexpr int parts = 3;
  Eigen::Array4d at{0, 1.0 / 3, 2.0 / 3, 1}, gap, rate;

  FourGaps(const SplineSegment& segment, const Eigen::Vector3d& x, double r) {
    Eigen::Array4d square = Eigen::Array4d::Zero(), along = Eigen::Array4d::Zero();
    for (int i = 0; i < 3; ++i) {
      const double c1 = segment.c1[i], c2 = segment.c2[i], c3 = segment.c3[i];
      const Eigen::Array4d apart = segment.c0[i] - x[i] + at * (c1 + at * (c2 + at * c3));
      square += apart.square();
      along += apart * (c1 + at * (2 * c2 + at * (3 * c3)));
    }
    const Eigen::Array4d distance = square.sqrt();
    gap = distance - (segment.r0 + r) - at * segment.r1;
    rate = along / distance - segment.r1;
  }
};

/// The nearest point of a segment to x, where the skin has radius r. Samples separate its minima,
/// since along a strand that winds about x the gap falls and rises more than once.
Nearest nearest_on(const SplineSegment& segment, const Eigen::Vector3d& x, double r) {
  const FourGaps samples(segment, x, r);
  int least = 0;
  Nearest best;
  best.gap = samples.gap.minCoeff(&least);
  best.t = samples.at[least];
  for (int k = 0; k < FourGaps::parts; ++k) {
    const double left = samples.rate[k], right = samples.rate[k + 1];
    if (!(left < 0 && right > 0)) continue;
    const double t = least_between(segment, x, r, samples.at[k], samples.at[k + 1],
                                   (k + left / (left - right)) / FourGaps::parts);
    const double gap = GapAt(segment, x, r, t).gap;
    if (gap < best.gap) best.t = t, best.gap = gap;
  }
  return best;
}

/// Finds nearest points of the body's other strands for points of one strand.
class NearestFinder {
 public:
  /// Finds those with a gap of `level` (cm) and of the margin.
  NearestFinder(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                double level, bool tail, std::vector<int>& near)
      : segments_(segments),
        settings_(settings),
        sought_(std::max(level, settings.margin)),
        tail_(tail),
        near_(near) {}

  /// For the point `t` of segment `own`, among all segments that may touch it.
  Nearest nearest(int own, double t) {
    const Eigen::Vector3d x = segments_[own].point(t);
    const double r = segments_[own].radius(t);
    const double most = sought_ + 0.01 * segments_[own].r0;  // more than the caller needs
    if (own != own_) list_near(segments_, settings_, tail_, own_ = own, most, near_);
    Nearest best;
    best.gap = most;
    // First the one whose middle is nearest: most others then are too far.
    const auto square = [&](int k) { return (segments_[k].middle - x).squaredNorm(); };
    const auto first = std::ranges::min_element(near_, {}, square);
    const auto look = [&](int k) {
      const double reach = best.gap + segments_[k].bound + r;
      if (square(k) >= reach * reach) return;
      const Nearest there = nearest_on(segments_[k], x, r);
      if (there.gap < best.gap) best = {there.gap, k, there.t};
    };
    if (first != near_.end()) look(*first);
    for (const int k : near_) {
      if (k != *first) look(k);
    }
    if (best.segment >= 0) {
      const Eigen::Vector3d apart = x - segments_[best.segment].point(best.t);
      best.rate = apart.dot(segments_[own].slope(t)) / apart.norm() - segments_[own].r1;
    }
    return best;
  }

 private:
  const std::vector<SplineSegment>& segments_;
  const ContactSettings& settings_;
  double sought_;
  bool tail_;
  int own_ = -1;            ///< segment of the last search
  std::vector<int>& near_;  ///< segments that may be near it
};

/// A point of a segment, and the point nearest to it.
struct Place {
  double t;
  Nearest nearest;
};

/// Where the gap passes `level` between the point `inside` of the level set and the point `end` of
/// segment `own` outside of it. Newton's method within an interval that shrinks.
Place close_in(double level, int own, double inside, Place end, NearestFinder& strand) {
  auto& [at, here] = end;
  double outside = at;
  for (int k = 0; k < iteration_limit; ++k) {
    const double newton = at - (here.gap - level) / here.rate;
    const bool within = std::min(inside, outside) < newton && newton < std::max(inside, outside);
    const bool settled = within && std::abs(newton - at) <= step_tolerance;
    at = within ? newton : 0.5 * (inside + outside);
    here = strand.nearest(own, at);
    (here.gap <= level ? inside : outside) = at;
    if (settled) break;
  }
  if (here.segment < 0) here = strand.nearest(own, at = inside);
  return end;
}

/// The end of the level set around the point `t` of segment `own`, towards the tail or the head:
/// walks on while borders of segments are within it, then closes in on the last segment.
Contact end_from(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                 double level, bool tail, int own, double t, std::vector<int>& near) {
  NearestFinder strand(segments, settings, level, tail, near);
  const double border = tail ? 1 : 0;
  const auto is_last = [&](int segment) {
    return tail ? segment + 1 == static_cast<int>(segments.size()) ||
                      segments[segment + 1].obstacle >= 0
                : segment == 0;
  };
  Place end{border, strand.nearest(own, border)};
  while (end.nearest.gap <= level && !is_last(own)) {
    own += tail ? 1 : -1;
    t = 1 - border;
    end.nearest = strand.nearest(own, border);
  }
  if (end.nearest.gap > level) end = close_in(level, own, t, end, strand);
  const auto [at, other] = end;
  return tail ? contact_at(segments, other.segment, other.t, own, at)
              : contact_at(segments, own, at, other.segment, other.t);
}

}  // namespace

TouchingEnds touching_ends(const std::vector<SplineSegment>& segments,
                           const std::vector<Contact>& contacts, const Scene& scene,
                           EndPatches& patches) {
  patches.first.clear();
  patches.last.clear();
  const double gap = scene.controller.contact_gap;
  const Contact* first = nullptr;
  const Contact* last = nullptr;
  for (const Contact& contact : contacts) {
    if (contact.gap > gap) continue;
    if (first == nullptr || contact.arc_a < first->arc_a) first = &contact;
    if (last == nullptr || contact.arc_b > last->arc_b) last = &contact;
  }
  if (first == nullptr) return {};
  const Contact head_end =
      end_from(segments, scene.contact, gap, false, first->segment_a, first->t_a, patches.near);
  const Contact tail_end =
      end_from(segments, scene.contact, gap, true, last->segment_b, last->t_b, patches.near);
  contact_patch(segments, scene, head_end, false, patches.near, patches.first);
  contact_patch(segments, scene, tail_end, true, patches.near, patches.last);
  return {head_end, tail_end, end_arc(head_end, patches.first, false),
          end_arc(tail_end, patches.last, true)};
}

double end_arc(const Contact& end, const std::vector<PatchPoint>& patch, bool tail) {
  const auto own_arc = [tail](const Contact& c) { return tail ? c.arc_b : c.arc_a; };
  if (patch.empty()) return own_arc(end);
  double mean = 0;
  for (const auto& [contact, share] : patch) mean += share * own_arc(contact);
  return mean;
}

}  // namespace hagfish
