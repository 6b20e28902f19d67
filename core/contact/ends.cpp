#include "core/contact/ends.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

constexpr int iteration_limit = 50;
// A Newton step in a parameter of [0, 1] below this leaves an error of its square.
constexpr double step_tolerance = 1e-8;

/// The point of the other strand that is nearest to one of the first.
struct Nearest {
  double gap = 0;    ///< cm; at most the margin, where there is none
  int segment = -1;  ///< -1: there is none
  double t = 0;
  double rate = NAN;  ///< of the gap by the first strand's parameter, cm
};

/// The nearest point of `other` to x, where the skin of radius r is: Newton's method on the gap's
/// slope from the lowest of three samples, or Gauss-Newton's where that would go up.
void descend(const SplineSegment& other, const Eigen::Vector3d& x, double r, double& t,
             double& gap) {
  const auto gap_at = [&](double at) {
    return (other.point(at) - x).norm() - other.radius(at) - r;
  };
  gap = std::numeric_limits<double>::infinity();
  for (const double at : {0.0, 0.5, 1.0}) {
    const double here = gap_at(at);
    if (here < gap) {
      gap = here;
      t = at;
    }
  }
  for (int k = 0; k < iteration_limit; ++k) {
    const Eigen::Vector3d apart = other.point(t) - x;
    const double distance = apart.norm();
    if (distance == 0) return;
    const Eigen::Vector3d slope = other.slope(t);
    const double along = apart.dot(slope) / distance;
    const double down = other.r1 - along;
    if ((t <= 0 && down <= 0) || (t >= 1 && down >= 0)) return;
    const double gauss = (slope.squaredNorm() - along * along) / distance;
    const double newton = gauss + apart.dot(other.bend(t)) / distance;
    double step = down / std::max(newton, 0.1 * slope.squaredNorm() / distance);
    for (bool lower = false; !lower;) {
      const double next = std::clamp(t + step, 0.0, 1.0);
      const double there = gap_at(next);
      const bool small = !(std::abs(next - t) > step_tolerance);  // what is no number ends it, too
      lower = there < gap;
      if (lower) {
        t = next;
        gap = there;
      }
      if (small) return;
      step *= 0.5;
    }
  }
}

/// One strand's points against the body's others.
class Strand {
 public:
  Strand(const std::vector<SplineSegment>& segments, const ContactSettings& settings, bool tail)
      : segments_(segments),
        settings_(settings),
        least_arc_(settings.least_arc * (1 - 1e-9)),
        tail_(tail) {}

  /// Of those that may touch segment `own`, to its point `t`.
  Nearest nearest(int own, double t) const {
    const SplineSegment& segment = segments_[own];
    const Eigen::Vector3d x = segment.point(t);
    const double r = segment.radius(t);
    Nearest best;
    best.gap = settings_.margin + 0.01 * r;  // beyond what is asked for
    const int count = static_cast<int>(segments_.size());
    for (int k = tail_ ? 0 : own + 1; k < (tail_ ? own : count); ++k) {
      const SplineSegment& other = segments_[k];
      const double reach = best.gap + other.bound + r;
      if ((other.middle - x).squaredNorm() >= reach * reach || other.obstacle >= 0 ||
          (tail_ ? segment.s0 - other.arc(1) : other.s0 - segment.arc(1)) < least_arc_) {
        continue;
      }
      double there = 0, gap = 0;
      descend(other, x, r, there, gap);
      if (gap < best.gap) best = {gap, k, there};
    }
    if (best.segment >= 0) {
      const Eigen::Vector3d apart = x - segments_[best.segment].point(best.t);
      best.rate = apart.dot(segment.slope(t)) / apart.norm() - segment.r1;
    }
    return best;
  }

 private:
  const std::vector<SplineSegment>& segments_;
  const ContactSettings& settings_;
  double least_arc_;  ///< with slack for rounding, as the search has it
  bool tail_;
};

/// Where the level set that holds the point `t` of segment `own` ends, to the tail or to the head.
Contact end_from(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                 double gap, bool tail, int own, double t) {
  const Strand strand(segments, settings, tail);
  const auto contact = [&](int segment, double at, const Nearest& pair) {
    return tail ? contact_at(segments, pair.segment, pair.t, segment, at)
                : contact_at(segments, segment, at, pair.segment, pair.t);
  };
  const double border = tail ? 1 : 0;
  const auto is_last = [&](int segment) {
    return tail ? segment + 1 == static_cast<int>(segments.size()) ||
                      segments[segment + 1].obstacle >= 0
                : segment == 0;
  };
  Nearest outer = strand.nearest(own, border);
  while (outer.gap <= gap && !is_last(own)) {
    own += tail ? 1 : -1;
    t = 1 - border;
    outer = strand.nearest(own, border);
  }
  if (outer.gap <= gap) return contact(own, border, outer);
  // Newton's method, with the point inside and that outside of the set closing in.
  double inside = t, outside = border;
  Nearest here = outer;
  double at = border;
  for (int k = 0; k < iteration_limit; ++k) {
    const double newton = at - (here.gap - gap) / here.rate;
    const bool within = std::min(inside, outside) < newton && newton < std::max(inside, outside);
    const bool settled = within && std::abs(newton - at) <= step_tolerance;
    at = within ? newton : 0.5 * (inside + outside);
    here = strand.nearest(own, at);
    (here.gap <= gap ? inside : outside) = at;
    if (settled) break;
  }
  if (here.segment < 0) here = strand.nearest(own, at = inside);
  return contact(own, at, here);
}

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
  return {end_from(segments, settings, gap, false, first->segment_a, first->t_a),
          end_from(segments, settings, gap, true, last->segment_b, last->t_b)};
}

}  // namespace hagfish
