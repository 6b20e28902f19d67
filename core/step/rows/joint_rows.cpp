#include "core/step/rows/joint_rows.hpp"

#include <cmath>

namespace hagfish {

Row cone_row(const BendingCone& cone, const Bend& bend, int number) {
  Row row;
  row.kind = RowKind::limit;
  row.id = {.of = RowId::Of::cone, .first = cone.dof, .number = number};
  row.shape = OnJoint{cone.dof, -bend.slope[0], -bend.slope[1]};
  return row;
}

void append_head_rows(const State& state, const ConstraintSettings& settings, double h,
                      std::vector<Row>& rows) {
  // The rotation from the clamped orientation, as a rotation vector of small angle, body frame.
  const Eigen::Vector3d turn = 2 * std::copysign(1.0, state.q[3]) * state.q.segment<3>(4);
  for (int k = 0; k < root_dofs; ++k) {
    Row& row = rows.emplace_back();
    row.kind = RowKind::head;
    row.id = {.of = RowId::Of::head, .first = k};
    row.shape = OnJoint{k};
    row.rhs = -settings.baumgarte / h * (k < 3 ? state.q[k] : turn[k - 3]);
    row.lower = -INFINITY;
  }
}

namespace {

void append_hinge_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                       double h, const NearBinding& wanted, std::vector<Row>& rows) {
  // Most hinges are further than this from both limits.
  const double reach = std::max(wanted.slack, wanted.slack_at_rest);
  const double clear = h * (reach + 1e-9 * std::abs(reach));  // beyond rounding
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double least_gap = std::min(state.q[k + 1] - hinge.lower, hinge.upper - state.q[k + 1]);
    if (least_gap >= 0 && least_gap - h * std::abs(wanted.v[k]) > clear && least_gap > clear) {
      continue;
    }
    // The nearer side first: a mirror image swaps the sides, and this order stays the same.
    const double nearer = state.q[k + 1] - hinge.lower <= hinge.upper - state.q[k + 1] ? 1 : -1;
    for (const double sign : {nearer, -nearer}) {
      const double gap = sign > 0 ? state.q[k + 1] - hinge.lower : hinge.upper - state.q[k + 1];
      const std::optional<double> rhs = unilateral(gap, settings, h, INFINITY);
      if (!rhs || !std::isfinite(gap) || !wanted(sign * wanted.v[k], *rhs)) continue;
      Row& row = rows.emplace_back();
      row.kind = RowKind::limit;
      row.id = {.of = sign > 0 ? RowId::Of::lower : RowId::Of::upper, .first = k};
      row.shape = OnJoint{k, sign};
      row.rhs = *rhs;
    }
  }
}

void append_cone_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                      double h, const NearBinding& wanted, std::vector<Row>& rows) {
  for (const BendingCone& cone : model.cones) {
    const auto angles = state.q.segment<2>(cone.dof + 1);
    // θ is at most the length of the vector of both angles and grows no faster. By this bound most
    // joints are far from their cones.
    if (!wanted(-wanted.v.segment<2>(cone.dof).norm(), (angles.norm() - cone.limit) / h)) continue;
    const Bend bend = total_bend(angles[0], angles[1]);
    const std::optional<double> rhs = unilateral(cone.limit - bend.angle, settings, h, INFINITY);
    if (!rhs || bend.slope.isZero(0)) continue;
    Row& row = rows.emplace_back(cone_row(cone, bend, 0));
    row.rhs = *rhs;
    if (!wanted(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) rows.pop_back();
  }
}

}  // namespace

void append_limit_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                       double h, const NearBinding& wanted, std::vector<Row>& rows) {
  append_hinge_rows(model, state, settings, h, wanted, rows);
  append_cone_rows(model, state, settings, h, wanted, rows);
}

}  // namespace hagfish
