#include "core/step/rows/flesh_rows.hpp"

#include "core/step/rows/contact_rows.hpp"

namespace hagfish {
namespace {

/// h/2 + τ, s.
double lag_of(const Scene& scene, double gap) {
  return 0.5 * scene.time.step + (gap < 0 ? scene.flesh.relaxation : 0);
}

/// Makes `row`, the rate of the gap at a point of this weight (cm), one of flesh.
void soften(const Scene& scene, double gap, double weight, Row& row) {
  const double stiffness = scene.flesh.stiffness * weight, lag = lag_of(scene, gap);
  row.rhs = -gap / lag;
  row.compliance = 1 / (stiffness * scene.time.reach() * lag);
  row.damper = gap < 0 ? stiffness * scene.flesh.relaxation : 0;
}

}  // namespace

Eigen::Vector3d normal_ahead(const Observation& now, const Contact& contact,
                             const BetweenPoints& points, double time) {
  Eigen::Vector3d apart = now.segments[contact.segment_a].point(contact.t_a) -
                          now.segments[contact.segment_b].point(contact.t_b);
  const auto move = [&](const SplineMix& mix, double by) {
    for (int k = 0; k < mix.count; ++k) {
      apart += by * mix.weight[k] * now.kin.centre_velocity.col(mix.first + k);
    }
  };
  move(points.a, time);
  move(points.b, -time);
  return apart.normalized();
}

void append_flesh_rows(const StepInput& in, const std::vector<SplineSegment>* at,
                       const NearBinding& wanted, std::vector<Row>& rows) {
  for (const FleshPoint& point : in.observation.flesh.points) {
    const Contact& contact = point.contact;
    Row& row = rows.emplace_back(contact_row(in.model, contact, at));
    row.id.of = RowId::Of::flesh;
    if (point.own != contact.segment_a) std::swap(row.id.first, row.id.second);
    row.id.number = point.number;
    if (at == nullptr && contact.obstacle >= 0) {
      auto& points = std::get<BetweenPoints>(row.shape);
      points.direction = normal_ahead(in.observation, contact, points, 0.5 * in.scene.time.step);
    }
    soften(in.scene, contact.gap, point.weight, row);
    if (!wanted.of_points(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) rows.pop_back();
  }
  visit_plane_gaps(in.model, in.observation.kin, [&](const PlaneGap& gap) {
    const double speed = gap.plane.normal.dot(wanted.bodies.centre.col(gap.body));
    if (!wanted.of_points(speed, -gap.gap / lag_of(in.scene, gap.gap))) return;
    soften(in.scene, gap.gap, plane_weight(in.model, gap.body), rows.emplace_back(plane_row(gap)));
  });
}

}  // namespace hagfish
