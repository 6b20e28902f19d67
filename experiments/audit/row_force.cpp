#include "experiments/audit/row_force.hpp"

#include <cmath>

#include "core/step/rows/contact_rows.hpp"
#include "core/step/rows/flesh_rows.hpp"

namespace hagfish {

Row motion_row(const Model& model, const Eigen::Vector3d& direction, double a, double b) {
  const auto mix = [&model](double parameter) {
    const auto [segment, t] = spline_point(model, parameter);
    return spline_mix(segment, t, model.body_count());
  };
  Row row;
  row.shape = BetweenPoints{direction, mix(a), std::isnan(b) ? SplineMix{} : mix(b), {}, {}};
  return row;
}

Contact contact_of(const Model& model, const std::vector<SplineSegment>& segments, double a,
                   double b) {
  const auto [segment_a, t_a] = spline_point(model, a);
  const auto [segment_b, t_b] = spline_point(model, b);
  return contact_at(segments, segment_a, t_a, segment_b, t_b);
}

Eigen::Vector3d push_of(const LogContents& log, const AuditedFrame& frame,
                        const LoggedContact& contact) {
  const Contact there = placed_contact(log.model, frame.kin, frame.segments, contact);
  const Scene& scene = log.resolved.scene;
  const bool on_strand = contact.obstacle >= 0 && !std::isnan(contact.on_obstacle);
  if (!scene.flesh.present() || log.midpoint() || !on_strand) return there.normal;
  return normal_ahead(frame.observation, there, between_points(there, there.normal, log.model),
                      0.5 * scene.time.step);
}

Eigen::VectorXd force_of(const Model& model, const Kinematics& kin, const Row& row, double lambda) {
  Matrix6Xd wrench = Matrix6Xd::Zero(6, model.body_count());
  Eigen::VectorXd joint = Eigen::VectorXd::Zero(model.nv());
  add_row(row, kin, lambda, wrench, joint);
  return generalised_force(model, kin, wrench);
}

}  // namespace hagfish
