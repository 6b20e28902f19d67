#include "experiments/audit/logged_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/obstacles.hpp"

namespace hagfish {

std::vector<LoggedContact> logged_contacts(const LogContents& log) {
  const std::vector<std::int64_t> frame = log.h5.integers("/contacts/frame");
  const std::vector<double> a = log.h5.doubles("/contacts/spline_a");
  const std::vector<double> b = log.h5.doubles("/contacts/spline_b");
  const std::vector<double> force = log.h5.doubles("/contacts/force");
  std::vector<LoggedContact> contacts;
  for (std::size_t k = 0; k < frame.size(); ++k) {
    contacts.push_back({frame[k], a[k], b[k], std::isnan(b[k]) ? 0 : -1,
                        std::numeric_limits<double>::quiet_NaN(), force[k]});
  }
  if (!log.resolved.scene.obstacles.empty()) {
    const std::vector<std::int64_t> obstacle = log.h5.integers("/contacts/obstacle");
    const std::vector<double> on_obstacle = log.h5.doubles("/contacts/spline_obstacle");
    for (std::size_t k = 0; k < frame.size(); ++k) {
      contacts[k].obstacle = static_cast<int>(obstacle[k]);
      contacts[k].on_obstacle = on_obstacle[k];
    }
  }
  return contacts;
}

bool is_placed(const Model& model, const LoggedContact& contact) {
  if (!on_spline(model, contact.a)) return false;
  if (contact.obstacle == -1) return on_spline(model, contact.b) && std::isnan(contact.on_obstacle);
  if (contact.obstacle < 0 || contact.obstacle >= static_cast<int>(model.obstacles.size()) ||
      !std::isnan(contact.b)) {
    return false;
  }
  const Obstacle& obstacle = model.obstacles[contact.obstacle];
  if (const Strand* strand = obstacle.strand()) {
    return contact.on_obstacle >= 0 && contact.on_obstacle <= segments_of(*strand);
  }
  return std::isnan(contact.on_obstacle) && contact.a == std::floor(contact.a);
}

Contact placed_contact(const Model& model, const Kinematics& kin,
                       const std::vector<SplineSegment>& segments, const LoggedContact& logged) {
  const auto [segment_a, t_a] = spline_point(model, logged.a);
  if (logged.obstacle == -1) {
    const auto [segment_b, t_b] = spline_point(model, logged.b);
    return contact_at(segments, segment_a, t_a, segment_b, t_b);
  }
  const Obstacle& obstacle = model.obstacles[logged.obstacle];
  if (const Strand* strand = obstacle.strand()) {
    const int segment = std::min(static_cast<int>(logged.on_obstacle), segments_of(*strand) - 1);
    return contact_at(segments, segment_a, t_a, strand_begin(model, logged.obstacle) + segment,
                      logged.on_obstacle - segment);
  }
  const Plane& plane = *obstacle.plane();
  Contact contact;
  contact.segment_a = segment_a;
  contact.t_a = t_a;
  contact.arc_a = segments[segment_a].arc(t_a);
  contact.arc_b = std::numeric_limits<double>::infinity();
  contact.gap = plane_gap(model, kin, plane, static_cast<int>(logged.a));
  contact.normal = plane.normal;
  contact.tangent_a = segments[segment_a].slope(t_a).normalized();
  contact.tangent_b.setZero();
  contact.obstacle = logged.obstacle;
  return contact;
}

}  // namespace hagfish
