#include "core/step/rows/rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// The last number of a limit row's id: 0 for the lower limit of a hinge, 1 for the upper limit,
/// larger ones for a cone.
constexpr int first_cone_row = 2;

/// The last number of an obstacle row's id: the index of a plane, or from here on a strand's
/// segment.
constexpr int first_strand_segment = 1 << 16;

/// Difference between the ids of a contact's rows in one step: more than any number above.
constexpr std::int64_t next_cut = std::int64_t{1} << 48;

std::int64_t row_id(RowKind kind, int first, int second) {
  return (static_cast<std::int64_t>(kind) << 40) | (static_cast<std::int64_t>(first) << 20) |
         second;
}

/// The first number of the id of a row of Eq. 6: 0 and 1 for the knot's first and last contact,
/// from here on its segment a.
constexpr int first_segment = 2;

/// The mix a less the mix b of columns.
template <class Columns>
auto apart(const Row& row, const Columns& columns) {
  Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> sum;
  sum.setZero();
  for (int k = 0; k < row.a.count; ++k) {
    sum += row.a.weight[k] * columns.col(row.a.first + k);
  }
  for (int k = 0; k < row.b.count; ++k) {
    sum -= row.b.weight[k] * columns.col(row.b.first + k);
  }
  return sum;
}

/// C q̇ of a row with points, along its direction ẋ_a - ẋ_b, or of a patch.
double relative_velocity(const Row& row, const BodyVelocities& bodies) {
  if (!row.patch.empty()) {
    double sum = 0;
    for (const auto& [body, moment, force] : row.patch) {
      sum += moment.dot(bodies.twist.col(body).head<3>()) +
             force.dot(bodies.twist.col(body).tail<3>());
    }
    return sum;
  }
  const double speed = row.direction.dot(row.at ? point_velocity(apart(row, bodies.twist), *row.at)
                                                : apart(row, bodies.centre));
  return row.head_couple ? speed + row.head_couple->dot(bodies.twist.col(0).head<3>()) : speed;
}

/// The right-hand side of a unilateral row at `gap`; none if the row does not act. Speculative rows
/// let a gap close within the step. A violation is corrected over several steps, at no more than
/// the speed `fastest`.
std::optional<double> unilateral(double gap, const ConstraintSettings& settings, double h,
                                 double fastest) {
  if (gap >= 0 && settings.activation == Activation::violated) {
    return std::nullopt;
  }
  return gap >= 0 ? -gap / h : std::min(-settings.baumgarte * gap / h, fastest);
}

}  // namespace

std::string row_name(const Model& model, const Row& row) {
  const int first = static_cast<int>((row.id >> 20) & 0xfffff);
  const int second = static_cast<int>(row.id & 0xfffff);
  switch (row.kind) {
    case RowKind::head:
      return "head clamp, velocity " + std::to_string(row.dof);
    case RowKind::limit:
      if (second >= first_cone_row) {
        return "bending limit of " + cone_joint_name(model, {row.dof, 0}) + " (total angle)";
      }
      return (row.sign > 0 ? "lower" : "upper") + std::string(" limit of ") +
             dof_name(model, row.dof);
    case RowKind::contact:
      return "contact of bodies " + std::to_string(first) + " and " + std::to_string(second);
    case RowKind::obstacle:
      return model.obstacles[row.obstacle].name + " at body " + std::to_string(first);
    case RowKind::thigmotaxis:
      return (first < first_segment
                  ? std::string(first == 0 ? "first" : "last") + " thigmotaxis contact"
                  : "thigmotaxis of bodies " + std::to_string(first - first_segment) + " and " +
                        std::to_string(second / 2)) +
             (along_a(row) ? ", along t_a" : ", along t_b");
  }
  return "row";
}

int place_in_step(const Model& model, const Row& row) {
  if (row.prescribed || row.kind == RowKind::head) {
    return row.dof - 2 * model.nv();
  }
  if (row.dof >= 0) {
    return -row.dof - (row.unit() ? 1 : 2);
  }
  const int points = std::max(row.a.first + row.a.count, row.b.first + row.b.count);
  const Body& last = model.bodies[row.patch.empty() ? points - 1 : row.patch.back().body];
  return -last.first_dof - last.dofs;
}

std::int64_t thigmotaxis_row_id(KnotEnd end, const Contact& contact, bool on_a) {
  const int along = on_a ? 0 : 1;
  return end == KnotEnd::neither ? row_id(RowKind::thigmotaxis, first_segment + contact.segment_a,
                                          2 * contact.segment_b + along)
                                 : row_id(RowKind::thigmotaxis, static_cast<int>(end), along);
}

bool along_a(const Row& row) { return row.id % 2 == 0; }

double row_velocity(const Row& row, const BodyVelocities& bodies, const Eigen::VectorXd& v) {
  if (row.dof < 0) {
    return relative_velocity(row, bodies);
  }
  return row.sign * v[row.dof] + (row.unit() ? 0 : row.next_sign * v[row.dof + 1]);
}

void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint) {
  if (row.dof >= 0) {
    joint[row.dof] += row.sign * lambda;
    if (!row.unit()) {
      joint[row.dof + 1] += row.next_sign * lambda;
    }
    return;
  }
  visit_forces(row, kin,
               [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                 wrench.col(body).head<3>() += lambda * moment;
                 wrench.col(body).tail<3>() += lambda * force;
               });
}

std::int64_t contact_row_id(const Contact& contact) {
  return contact.obstacle < 0 ? row_id(RowKind::contact, contact.segment_a, contact.segment_b)
                              : row_id(RowKind::obstacle, contact.segment_a,
                                       first_strand_segment + contact.segment_b);
}

void set_points(Row& row, const Contact& contact, const Eigen::Vector3d& direction,
                const Model& model) {
  row.direction = direction;
  row.a = spline_mix(contact.segment_a, contact.t_a, model.body_count());
  if (contact.obstacle < 0) {
    row.b = spline_mix(contact.segment_b, contact.t_b, model.body_count());
  } else {
    row.b = {};
    row.b.parameter = strand_parameter(model, contact);
  }
}

Row contact_row(const Model& model, const Contact& contact, const std::vector<SplineSegment>* at,
                int number) {
  Row row;
  row.kind = contact.obstacle < 0 ? RowKind::contact : RowKind::obstacle;
  row.obstacle = contact.obstacle;
  row.id = contact_row_id(contact) + number * next_cut;
  set_points(row, contact, at == nullptr ? contact.normal : contact_normal(*at, contact), model);
  return row;
}

Row plane_row(const Model& model, int obstacle, int body) {
  Row row;
  row.kind = RowKind::obstacle;
  row.obstacle = obstacle;
  row.id = row_id(RowKind::obstacle, body, obstacle);
  row.direction = model.obstacles[obstacle].normal;
  row.a = {body, 1, {1}, static_cast<double>(body)};
  row.b.parameter = std::numeric_limits<double>::quiet_NaN();  // of a strand's point
  return row;
}

Row cone_row(const BendingCone& cone, const Bend& bend, int number) {
  Row row;
  row.kind = RowKind::limit;
  row.id = row_id(RowKind::limit, cone.dof, first_cone_row + number);
  row.dof = cone.dof;
  row.sign = -bend.slope[0];
  row.next_sign = -bend.slope[1];
  return row;
}

void append_head_rows(const State& state, const ConstraintSettings& settings, double h,
                      std::vector<Row>& rows) {
  // The rotation from the clamped orientation, as a rotation vector of small angle, body frame.
  const Eigen::Vector3d turn = 2 * std::copysign(1.0, state.q[3]) * state.q.segment<3>(4);
  for (int k = 0; k < root_dofs; ++k) {
    Row& row = rows.emplace_back();
    row.kind = RowKind::head;
    row.id = row_id(RowKind::head, k, 0);
    row.dof = k;
    row.rhs = -settings.baumgarte / h * (k < 3 ? state.q[k] : turn[k - 3]);
    row.lower = -unbounded;
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
      const std::optional<double> rhs = unilateral(gap, settings, h, unbounded);
      if (!rhs || !std::isfinite(gap) || !wanted(sign * wanted.v[k], *rhs)) {
        continue;
      }
      Row& row = rows.emplace_back();
      row.kind = RowKind::limit;
      row.id = row_id(RowKind::limit, k, sign > 0 ? 0 : 1);
      row.dof = k;
      row.sign = sign;
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
    if (!wanted(-wanted.v.segment<2>(cone.dof).norm(), (angles.norm() - cone.limit) / h)) {
      continue;
    }
    const Bend bend = total_bend(angles[0], angles[1]);
    const std::optional<double> rhs = unilateral(cone.limit - bend.angle, settings, h, unbounded);
    if (!rhs || bend.slope.isZero(0)) {
      continue;
    }
    Row& row = rows.emplace_back(cone_row(cone, bend, 0));
    row.rhs = *rhs;
    if (!wanted(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) {
      rows.pop_back();
    }
  }
}

}  // namespace

void append_limit_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                       double h, const NearBinding& wanted, std::vector<Row>& rows) {
  append_hinge_rows(model, state, settings, h, wanted, rows);
  append_cone_rows(model, state, settings, h, wanted, rows);
}

void append_contact_row(const Model& model, const Contact& contact,
                        const std::vector<SplineSegment>* at, const ConstraintSettings& settings,
                        double h, const NearBinding& wanted, std::vector<Row>& rows) {
  const std::optional<double> rhs = unilateral(contact.gap, settings, h, settings.baumgarte_speed);
  if (!rhs) {
    return;
  }
  Row& row = rows.emplace_back(contact_row(model, contact, at));
  row.rhs = *rhs;
  if (!wanted.of_points(row_velocity(row, wanted.bodies, wanted.v), row.rhs)) {
    rows.pop_back();
  }
}

void append_plane_rows(const Model& model, const Kinematics& kin,
                       const ConstraintSettings& settings, double h, const NearBinding& wanted,
                       std::vector<Row>& rows) {
  visit_plane_gaps(model, kin, [&](int obstacle, int body, double gap) {
    const std::optional<double> rhs = unilateral(gap, settings, h, settings.baumgarte_speed);
    const Eigen::Vector3d& normal = model.obstacles[obstacle].normal;
    if (rhs && wanted.of_points(normal.dot(wanted.bodies.centre.col(body)), *rhs)) {
      rows.emplace_back(plane_row(model, obstacle, body)).rhs = *rhs;
    }
  });
}

}  // namespace hagfish
