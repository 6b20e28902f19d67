#include "core/contact/ends.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

constexpr int iteration_limit = 50;
// A Newton step in a parameter of [0, 1] below this leaves an error of its square.
constexpr double step_tolerance = 1e-8;

/// From a point x, where the skin of radius r is, to the point `t` of a segment.
struct PointGap {
  PointGap(const SplineSegment& segment, const Eigen::Vector3d& x, double r, double at)
      : t(at), apart(segment.point(at) - x), slope(segment.slope(at)), distance(apart.norm()) {
    gap = distance - segment.radius(at) - r;
    along = apart.dot(slope) / distance;
    rate = along - segment.r1;
  }
  double t;
  Eigen::Vector3d apart, slope;  ///< cm
  double distance, gap;          ///< cm
  double along, rate;            ///< of the distance and of the gap by t, cm
};

/// Where `other` is nearest to x: at an end, unless the gap falls inwards from both. Else by
/// Newton's method on the gap's rate, or Gauss-Newton's where that would go up.
PointGap nearest(const SplineSegment& other, const Eigen::Vector3d& x, double r) {
  const PointGap begin(other, x, r, 0), end(other, x, r, 1);
  if (!(begin.rate < 0 && end.rate > 0)) return begin.gap <= end.gap ? begin : end;
  PointGap here(other, x, r, begin.rate / (begin.rate - end.rate));
  for (int k = 0; k < iteration_limit && here.distance > 0; ++k) {
    const double gauss = (here.slope.squaredNorm() - here.along * here.along) / here.distance;
    const double newton = gauss + here.apart.dot(other.bend(here.t)) / here.distance;
    double step = -here.rate / std::max(newton, 0.1 * here.slope.squaredNorm() / here.distance);
    for (bool lower = false; !lower; step *= 0.5) {
      const PointGap there(other, x, r, std::clamp(here.t + step, 0.0, 1.0));
      const bool small = !(std::abs(there.t - here.t) > step_tolerance);  // or no number
      lower = there.gap < here.gap;
      if (lower) here = there;
      if (small) return here;
    }
  }
  return here;
}

/// One end of the level set, on the strand that is nearer the tail or nearer the head.
class EndSearch {
 public:
  EndSearch(const std::vector<SplineSegment>& segments, const ContactSettings& settings, double gap,
            bool tail)
      : segments_(segments),
        least_arc_(settings.least_arc * (1 - 1e-9)),
        margin_(settings.margin),
        gap_(gap),
        tail_(tail) {}

  /// Where the part of the set ends that holds `contact`, to the tail or to the head.
  Contact from(const Contact& contact) const {
    int own = tail_ ? contact.segment_b : contact.segment_a;
    Place inside = {tail_ ? contact.t_b : contact.t_a,
                    tail_ ? contact.segment_a : contact.segment_b,
                    tail_ ? contact.t_a : contact.t_b, contact.gap};
    for (;;) {
      const Place border = nearest_of_all(own, tail_ ? 1 : 0);
      if (!(border.gap <= gap_)) return contact_of(own, outermost(own, inside, border.other));
      if (is_last(own)) return contact_of(own, border);
      inside = border;
      inside.t = tail_ ? 0 : 1;
      own += tail_ ? 1 : -1;
    }
  }

 private:
  /// A point `t` of the strand, and the nearest one of another segment; -1: there is none.
  struct Place {
    double t = 0;
    int other = -1;
    double t_other = 0;
    double gap = INFINITY;  ///< cm
  };

  PointGap gap_to(int other, int own, double t) const {
    return nearest(segments_[other], segments_[own].point(t), segments_[own].radius(t));
  }

  /// Visits the other segments that may be as near as `gap` to the point `t` of segment `own`.
  template <class Visit>
  void visit_near(int own, double t, double gap, const Visit& visit) const {
    const SplineSegment& segment = segments_[own];
    const Eigen::Vector3d x = segment.point(t);
    const double within = gap + segment.radius(t);
    const int count = static_cast<int>(segments_.size());
    for (int k = tail_ ? 0 : own + 1; k < (tail_ ? own : count); ++k) {
      const SplineSegment& other = segments_[k];
      const double reach = within + other.bound;
      const double arc = tail_ ? segment.s0 - other.arc(1) : other.s0 - segment.arc(1);
      if ((other.middle - x).squaredNorm() < reach * reach && other.obstacle < 0 &&
          arc >= least_arc_) {
        visit(k);
      }
    }
  }

  /// Of those within the margin.
  Place nearest_of_all(int own, double t) const {
    Place found = {t};
    visit_near(own, t, margin_, [&](int k) {
      const PointGap here = gap_to(k, own, t);
      if (here.gap < found.gap) found = {t, k, here.t, here.gap};
    });
    return found;
  }

  /// The outermost point of `own` within the gap, from one that is. The border of `own` is not, and
  /// `likely` is the nearest there.
  Place outermost(int own, Place inside, int likely) const {
    const auto go_on_beside = [&](int k) {
      if (gap_to(k, own, inside.t).gap <= gap_) inside = end_beside(k, own, inside.t);
    };
    if (likely >= 0) go_on_beside(likely);
    visit_near(own, inside.t, gap_, [&](int k) {
      if (k != likely) go_on_beside(k);
    });
    return inside;
  }

  /// Where segment k comes to be further than the gap from `own`, from its point `inside` outwards:
  /// by Newton's method, with the point inside and that outside of the set closing in.
  Place end_beside(int k, int own, double inside) const {
    const SplineSegment& segment = segments_[own];
    double outside = tail_ ? 1 : 0;
    double at = outside;
    PointGap here = gap_to(k, own, at);
    for (int i = 0; i < iteration_limit; ++i) {
      const double rate = -here.apart.dot(segment.slope(at)) / here.distance - segment.r1;
      const double newton = at - (here.gap - gap_) / rate;
      const bool within = std::min(inside, outside) < newton && newton < std::max(inside, outside);
      const bool settled = within && std::abs(newton - at) <= step_tolerance;
      at = within ? newton : 0.5 * (inside + outside);
      here = gap_to(k, own, at);
      (here.gap <= gap_ ? inside : outside) = at;
      if (settled) break;
    }
    return {at, k, here.t, here.gap};
  }

  bool is_last(int own) const {
    if (!tail_) return own == 0;
    return own + 1 == static_cast<int>(segments_.size()) || segments_[own + 1].obstacle >= 0;
  }

  Contact contact_of(int own, const Place& place) const {
    return tail_ ? contact_at(segments_, place.other, place.t_other, own, place.t)
                 : contact_at(segments_, own, place.t, place.other, place.t_other);
  }

  const std::vector<SplineSegment>& segments_;
  double least_arc_;  ///< cm, with slack for rounding, as the search for contacts has it
  double margin_;     ///< cm
  double gap_;        ///< cm
  bool tail_;
};

}  // namespace

TouchingEnds touching_ends(const std::vector<SplineSegment>& segments,
                           const std::vector<Contact>& contacts, const ContactSettings& settings,
                           double gap) {
  const Contact* first = nullptr;
  const Contact* last = nullptr;
  for (const Contact& contact : contacts) {
    if (contact.gap > gap) continue;
    if (first == nullptr || contact.arc_a < first->arc_a) first = &contact;
    if (last == nullptr || contact.arc_b > last->arc_b) last = &contact;
  }
  if (first == nullptr) return {};
  return {EndSearch(segments, settings, gap, false).from(*first),
          EndSearch(segments, settings, gap, true).from(*last)};
}

}  // namespace hagfish
