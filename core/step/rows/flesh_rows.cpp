#include "core/step/rows/flesh_rows.hpp"

#include "core/step/rows/contact_rows.hpp"

namespace hagfish {
namespace {

/// Makes `row`, the rate of the gap at a point of this weight (cm), one of flesh.
void soften(const Scene& scene, double gap, double weight, Row& row) {
  const double stiffness = scene.flesh.stiffness * weight;
  const double relaxation = gap < 0 ? scene.flesh.relaxation : 0;
  const double lag = 0.5 * scene.time.step + relaxation;
  row.rhs = -gap / lag;
  row.compliance = 1 / (stiffness * scene.time.reach() * lag);
  row.damper = stiffness * relaxation;
}

}  // namespace

Eigen::Vector3d normal_ahead(const Model& model, const Observation& now, const Contact& contact,
                             double time) {
  const BetweenPoints points = between_points(contact, Eigen::Vector3d::Zero(), model);
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
    if (at == nullptr) {
      std::get<BetweenPoints>(row.shape).direction =
          normal_ahead(in.model, in.observation, contact, 0.5 * in.scene.time.step);
    }
    soften(in.scene, contact.gap, point.weight, row);
    if (!wanted.of_points(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) rows.pop_back();
  }
  visit_plane_gaps(in.model, in.observation.kin, [&](const PlaneGap& gap) {
    Row& row = rows.emplace_back(plane_row(gap));
    soften(in.scene, gap.gap, plane_weight(in.model, gap.body), row);
    if (!wanted.of_points(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) rows.pop_back();
  });
}

}  // namespace hagfish
