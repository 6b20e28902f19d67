#include "core/step/rows/contact_rows.hpp"

#include <cmath>

#include "core/contact/obstacles.hpp"

namespace hagfish {

RowId contact_row_id(const Contact& contact) {
  return {.of = contact.obstacle < 0 ? RowId::Of::contact : RowId::Of::strand,
          .first = contact.segment_a,
          .second = contact.segment_b};
}

BetweenPoints between_points(const Contact& contact, const Eigen::Vector3d& direction,
                             const Model& model) {
  BetweenPoints points;
  points.direction = direction;
  points.a = spline_mix(contact.segment_a, contact.t_a, model.body_count());
  if (contact.obstacle < 0) {
    points.b = spline_mix(contact.segment_b, contact.t_b, model.body_count());
  } else {
    points.b.parameter = strand_parameter(model, contact);
  }
  return points;
}

Row contact_row(const Model& model, const Contact& contact, const std::vector<SplineSegment>* at,
                int number) {
  Row row;
  row.kind = contact.obstacle < 0 ? RowKind::contact : RowKind::obstacle;
  row.obstacle = contact.obstacle;
  row.id = contact_row_id(contact);
  row.id.number = number;
  row.shape =
      between_points(contact, at == nullptr ? contact.normal : contact_normal(*at, contact), model);
  return row;
}

Row plane_row(const PlaneGap& gap) {
  Row row;
  row.kind = RowKind::obstacle;
  row.obstacle = gap.obstacle;
  row.id = {.of = RowId::Of::plane, .first = gap.body, .second = gap.obstacle};
  BetweenPoints points;
  points.direction = gap.plane.normal;
  points.a = {gap.body, 1, {1}, static_cast<double>(gap.body)};
  points.b.parameter = NAN;  // of a strand's point
  row.shape = points;
  return row;
}

void append_contact_row(const Model& model, const Contact& contact,
                        const std::vector<SplineSegment>* at, const ConstraintSettings& settings,
                        double h, const NearBinding& wanted, std::vector<Row>& rows) {
  const std::optional<double> rhs = unilateral(contact.gap, settings, h, settings.baumgarte_speed);
  if (!rhs) return;
  Row& row = rows.emplace_back(contact_row(model, contact, at));
  row.rhs = *rhs;
  if (!wanted.of_points(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) rows.pop_back();
}

void append_plane_rows(const Model& model, const Kinematics& kin,
                       const ConstraintSettings& settings, double h, const NearBinding& wanted,
                       std::vector<Row>& rows) {
  visit_plane_gaps(model, kin, [&](const PlaneGap& at) {
    const std::optional<double> rhs = unilateral(at.gap, settings, h, settings.baumgarte_speed);
    if (rhs && wanted.of_points(at.plane.normal.dot(wanted.bodies.centre.col(at.body)), *rhs)) {
      rows.emplace_back(plane_row(at)).rhs = *rhs;
    }
  });
}

}  // namespace hagfish
