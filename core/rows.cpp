#include "core/rows.hpp"

#include <cmath>

namespace hagfish {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

std::int64_t row_id(RowKind kind, int first, int second) {
  return (static_cast<std::int64_t>(kind) << 40) | (static_cast<std::int64_t>(first) << 20) |
         second;
}

/// Adds weight * force at the spline point (segment, t).
void add_spline_force(Row& row, int segment, double t, int bodies, const Eigen::Vector3d& force) {
  const SplineMix mix = spline_mix(segment, t, bodies);
  for (int k = 0; k < mix.count; ++k) {
    row.force[row.forces++] = {mix.first + k, mix.weight[k] * force};
  }
}

/// The right-hand side of a unilateral row at `gap`, or false where the row is not in force.
/// Speculative rows let a gap close within the step; a violation is pushed out over several.
bool set_unilateral(Row& row, double gap, const ConstraintSettings& settings, double h) {
  if (gap >= 0 && settings.activation == Activation::violated) {
    return false;
  }
  row.rhs = gap >= 0 ? -gap / h : -settings.push_out * gap / h;
  return true;
}

}  // namespace

std::string row_name(const Model& model, const Row& row) {
  const int first = static_cast<int>((row.id >> 20) & 0xfffff);
  const int second = static_cast<int>(row.id & 0xfffff);
  switch (row.kind) {
    case RowKind::head:
      return "head clamp, velocity " + std::to_string(row.dof);
    case RowKind::limit: {
      int dof = 0;
      for (const JointName& joint : joint_names(model)) {
        for (const std::string& name : joint.dofs) {
          if (dof++ == row.dof) {
            return (row.sign > 0 ? "lower" : "upper") + std::string(" limit of ") + name;
          }
        }
      }
      break;
    }
    case RowKind::contact:
      return "contact of bodies " + std::to_string(first) + " and " + std::to_string(second);
    case RowKind::wall:
      return "head plate at body " + std::to_string(first);
    case RowKind::thigmotaxis:
      return std::string(first == 0 ? "first" : "last") + " thigmotaxis contact, along " +
             (second == 0 ? "t_a" : "t_b");
  }
  return "row";
}

double row_velocity(const Row& row, const Kinematics& kin, const Matrix6Xd& twist,
                    const Eigen::VectorXd& v) {
  if (row.dof >= 0) {
    return row.sign * v[row.dof];
  }
  double sum = 0;
  for (int k = 0; k < row.forces; ++k) {
    const auto& [body, force] = row.force[k];
    sum += force.dot(point_velocity(twist.col(body), kin.centre_offset(body)));
  }
  return sum;
}

void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint) {
  if (row.dof >= 0) {
    joint[row.dof] += row.sign * lambda;
    return;
  }
  for (int k = 0; k < row.forces; ++k) {
    const auto& [body, force] = row.force[k];
    wrench.col(body) += wrench_of_force(lambda * force, kin.centre_offset(body));
  }
}

std::vector<Row> head_rows(const State& state, const ConstraintSettings& settings, double h) {
  // The turn from the clamped orientation, as a rotation vector of small angle, body frame.
  const Eigen::Vector3d turn = 2 * std::copysign(1.0, state.q[3]) * state.q.segment<3>(4);
  std::vector<Row> rows(root_dofs);
  for (int k = 0; k < root_dofs; ++k) {
    rows[k].kind = RowKind::head;
    rows[k].id = row_id(RowKind::head, k, 0);
    rows[k].dof = k;
    rows[k].rhs = -settings.push_out / h * (k < 3 ? state.q[k] : turn[k - 3]);
    rows[k].lower = -unbounded;
  }
  return rows;
}

std::vector<Row> limit_rows(const Model& model, const State& state,
                            const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    for (const double sign : {1.0, -1.0}) {
      const double gap = sign > 0 ? state.q[k + 1] - hinge.lower : hinge.upper - state.q[k + 1];
      Row row;
      row.kind = RowKind::limit;
      row.id = row_id(RowKind::limit, k, sign > 0 ? 0 : 1);
      row.dof = k;
      row.sign = sign;
      if (std::isfinite(gap) && set_unilateral(row, gap, settings, h)) {
        rows.push_back(row);
      }
    }
  }
  return rows;
}

std::vector<Row> contact_rows(const Model& model, const ContactSet& contacts,
                              const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  const auto add = [&](const Contact& contact, bool waits) {
    Row row;
    row.kind = RowKind::contact;
    row.id = row_id(RowKind::contact, contact.segment_a, contact.segment_b);
    row.waits = waits;
    if (set_unilateral(row, contact.gap, settings, h)) {
      add_spline_force(row, contact.segment_a, contact.t_a, model.body_count(), contact.normal);
      add_spline_force(row, contact.segment_b, contact.t_b, model.body_count(), -contact.normal);
      rows.push_back(row);
    }
  };
  for (const Contact& contact : contacts.contacts) {
    add(contact, false);
  }
  for (const Contact& contact : contacts.others) {
    add(contact, true);
  }
  return rows;
}

std::vector<Row> wall_rows(const Model& model, const Kinematics& kin, const WallSettings& wall,
                           const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  double arc = 0;
  for (int b = 0; wall.present && b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    arc += body.length;
    if (arc - 0.5 * body.length < wall.neck) {
      continue;
    }
    Row row;
    row.kind = RowKind::wall;
    row.id = row_id(RowKind::wall, b, 0);
    if (set_unilateral(row, kin.centre(0, b) - body.radius, settings, h)) {
      row.force[row.forces++] = {b, Eigen::Vector3d::UnitX()};
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<Row> thigmotaxis_rows(const Model& model,
                                  const std::vector<ThigmotaxisCommand>& commands, double cap,
                                  double h) {
  std::vector<Row> rows;
  for (std::size_t place = 0; place < commands.size(); ++place) {
    const auto& [contact, speed] = commands[place];
    for (const bool along_a : {true, false}) {
      // Eq. 6: t_a' (ẋ_a - ẋ_b) >= v_a and t_b' (ẋ_b - ẋ_a) >= v_b.
      const Eigen::Vector3d on_a = along_a ? contact.tangent_a : -contact.tangent_b;
      Row row;
      row.kind = RowKind::thigmotaxis;
      row.id = row_id(RowKind::thigmotaxis, static_cast<int>(place), along_a ? 0 : 1);
      add_spline_force(row, contact.segment_a, contact.t_a, model.body_count(), on_a);
      add_spline_force(row, contact.segment_b, contact.t_b, model.body_count(), -on_a);
      row.rhs = along_a ? speed.a : speed.b;
      row.upper = cap * h;  // the soft row: its L1 slack is this bound's dual
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace hagfish
