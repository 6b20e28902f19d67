#include "core/contact/flesh.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/contact/gap_at.hpp"
#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

/// Whether the strand of a segment goes on to its neighbour; not to the dummy before a strand.
bool goes_on(const std::vector<SplineSegment>& segments, int segment, int neighbour) {
  return neighbour >= 0 && neighbour < static_cast<int>(segments.size()) &&
         segments[neighbour].obstacle == segments[segment].obstacle &&
         !std::isnan(segments[neighbour].bound);
}

/// The rate of the gap to the skin of radius r about x on the border of a segment, at 0 or 1: the
/// mean of both segments', whose tapers differ, so that a minimum is in one of them.
double border_rate(const std::vector<SplineSegment>& segments, int segment, double border,
                   const Eigen::Vector3d& x, double r) {
  const double own = GapAt(segments[segment], x, r, border).rate;
  const int neighbour = border > 0 ? segment + 1 : segment - 1;
  if (!goes_on(segments, segment, neighbour)) return own;
  return 0.5 * (own + GapAt(segments[neighbour], x, r, 1 - border).rate);
}

/// The parameter on a segment at which this gap is a minimum along the strand, if there is one.
std::optional<double> foot_on(const std::vector<SplineSegment>& segments, int segment,
                              const Eigen::Vector3d& x, double r) {
  const double begin = border_rate(segments, segment, 0, x, r);
  const double end = border_rate(segments, segment, 1, x, r);
  if (begin < 0 && end >= 0) {
    return least_between(segments[segment], x, r, 0, 1, begin / (begin - end));
  }
  if (begin >= 0 && !goes_on(segments, segment, segment - 1)) return 0;
  if (end < 0 && !goes_on(segments, segment, segment + 1)) return 1;
  return std::nullopt;
}

/// Adds the points of segment `own` whose gap to segment `other` is at most `most`.
void add_points(const std::vector<SplineSegment>& segments, const FleshSettings& settings,
                double most, int own, int other, std::vector<FleshPoint>& points) {
  const SplineSegment& strand = segments[own];
  const SplineSegment& opposite = segments[other];
  const int count = std::max(1, static_cast<int>(std::lround(strand.s1 / settings.spacing)));
  const bool both = strand.obstacle < 0 && opposite.obstacle < 0;
  for (int k = 0; k < count; ++k) {
    const double t = (k + 0.5) / count;
    const Eigen::Vector3d x = strand.point(t);
    const double r = strand.radius(t), reach = most + r + opposite.bound;
    if ((opposite.middle - x).squaredNorm() > reach * reach) continue;
    const std::optional<double> foot = foot_on(segments, other, x, r);
    if (!foot || GapAt(opposite, x, r, *foot).gap > most) continue;
    FleshPoint& point = points.emplace_back();
    point.contact = own < other ? contact_at(segments, own, t, other, *foot)
                                : contact_at(segments, other, *foot, own, t);
    point.own = own;
    point.number = k;
    point.weight = strand.s1 / count * (both ? 0.5 : 1);
    point.curvature = 1 / r + 1 / opposite.radius(*foot);
  }
}

}  // namespace

void find_flesh(const Model& model, const Scene& scene, const Kinematics& kin,
                const std::vector<SplineSegment>& segments, const ContactSet& found, Flesh& flesh) {
  flesh.points.clear();
  flesh.energy = 0;
  if (!scene.flesh.present()) return;
  // Twice what two points come nearer to each other in a step.
  const double fastest = std::sqrt(kin.centre_velocity.colwise().squaredNorm().maxCoeff());
  const double most = std::min(scene.contact.margin, 4 * scene.time.step * fastest);
  for (const auto* contacts : {&found.contacts, &found.on_obstacles, &found.near_pairs}) {
    for (const Contact& pair : *contacts) {
      const bool ring = pair.obstacle >= 0 && model.obstacles[pair.obstacle].strand()->closed;
      const auto add = [&](int own, int other) {
        add_points(segments, scene.flesh, most, own, other, flesh.points);
      };
      if (!ring) add(pair.segment_a, pair.segment_b);
      if (ring || pair.obstacle < 0) add(pair.segment_b, pair.segment_a);
    }
  }
  const auto press = [&](double gap, double weight) {
    if (gap < 0) flesh.energy += 0.5 * scene.flesh.stiffness * weight * gap * gap;
  };
  for (const FleshPoint& point : flesh.points) press(point.contact.gap, point.weight);
  visit_plane_gaps(model, kin,
                   [&](const PlaneGap& at) { press(at.gap, plane_weight(model, at.body)); });
}

Eigen::Matrix2Xd flesh_along(const Model& model, const FleshSettings& settings,
                             const Kinematics& kin, const Flesh& flesh) {
  Eigen::Matrix2Xd along = Eigen::Matrix2Xd::Zero(2, model.body_count());
  const auto press = [&](int body, double gap, double curvature) {
    if (gap >= 0) return;
    const double pressure = settings.stiffness * std::sqrt(-gap * curvature / 8);
    along.col(body) = along.col(body).cwiseMax(Eigen::Vector2d(-gap, pressure));
  };
  for (const auto& [contact, own, number, weight, curvature] : flesh.points) {
    press(contact.body_a(), contact.gap, curvature);
    if (contact.obstacle < 0) press(contact.body_b(), contact.gap, curvature);
  }
  visit_plane_gaps(model, kin, [&](const PlaneGap& at) {
    press(at.body, at.gap, 1 / model.bodies[at.body].radius);
  });
  return along;
}

}  // namespace hagfish
