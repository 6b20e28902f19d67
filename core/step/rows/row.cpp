#include "core/step/rows/row.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hagfish {
namespace {

/// The mix a less the mix b of columns.
template <class Columns>
auto apart(const BetweenPoints& row, const Columns& columns) {
  Eigen::Matrix<double, Columns::RowsAtCompileTime, 1> sum;
  sum.setZero();
  for (int k = 0; k < row.a.count; ++k) sum += row.a.weight[k] * columns.col(row.a.first + k);
  for (int k = 0; k < row.b.count; ++k) sum -= row.b.weight[k] * columns.col(row.b.first + k);
  return sum;
}

/// C q̇ of a row that is not on a joint.
double relative_velocity(const Row& row, const BodyVelocities& bodies) {
  if (const OverPatch* patch = row.patch()) {
    double sum = 0;
    for (const auto& [body, moment, force] : patch->wrenches) {
      sum += moment.dot(bodies.twist.col(body).head<3>()) +
             force.dot(bodies.twist.col(body).tail<3>());
    }
    return sum;
  }
  const BetweenPoints& points = row.points();
  const double speed =
      points.direction.dot(points.at ? point_velocity(apart(points, bodies.twist), *points.at)
                                     : apart(points, bodies.centre));
  return points.head_couple ? speed + points.head_couple->dot(bodies.twist.col(0).head<3>())
                            : speed;
}

}  // namespace

std::string row_name(const Model& model, const Row& row) {
  using Of = RowId::Of;
  const auto [of, end, first, second, _] = row.id;
  switch (of) {
    case Of::head:
      return fmt::format("head clamp, velocity {}", first);
    case Of::lower:
    case Of::upper:
      return fmt::format("{} limit of {}", of == Of::lower ? "lower" : "upper",
                         dof_name(model, first));
    case Of::cone:
      return "bending limit of " + cone_joint_name(model, {first, 0}) + " (total angle)";
    case Of::contact:
      return fmt::format("contact of bodies {} and {}", first, second);
    case Of::plane:
    case Of::strand:
      return fmt::format("{} at body {}", model.obstacles[row.obstacle].name, first);
    case Of::flesh: {
      const BetweenPoints& points = row.points();
      return row.obstacle < 0
                 ? fmt::format("flesh of bodies {} and {}", points.a.first, points.b.first)
                 : fmt::format("{} at body {}", model.obstacles[row.obstacle].name, points.a.first);
    }
    case Of::along_a:
    case Of::along_b:
      break;
  }
  return (end == KnotEnd::neither
              ? fmt::format("thigmotaxis of bodies {} and {}", first, second)
              : fmt::format("{} thigmotaxis contact", end == KnotEnd::first ? "first" : "last")) +
         (along_a(row) ? ", along t_a" : ", along t_b");
}

int order_in_step(const Model& model, const Row& row) {
  if (const OnJoint* joint = row.joint()) {
    return row.prescribed || row.kind == RowKind::head ? joint->dof - 2 * model.nv()
                                                       : -joint->dof - (row.unit() ? 1 : 2);
  }
  const auto& [direction, a, b, at, couple] = row.points();
  const OverPatch* patch = row.patch();
  const Body& last =
      model.bodies[patch != nullptr ? patch->wrenches.back().body
                                    : std::max(a.first + a.count, b.first + b.count) - 1];
  return -last.first_dof - last.dofs;
}

bool along_a(const Row& row) { return row.id.of == RowId::Of::along_a; }

double row_velocity(const Row& row, const BodyVelocities& bodies, const Eigen::VectorXd& v) {
  const OnJoint* joint = row.joint();
  if (joint == nullptr) return relative_velocity(row, bodies);
  return joint->sign * v[joint->dof] + (row.unit() ? 0 : joint->next_sign * v[joint->dof + 1]);
}

void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint) {
  if (const OnJoint* on = row.joint()) {
    joint[on->dof] += on->sign * lambda;
    if (!row.unit()) joint[on->dof + 1] += on->next_sign * lambda;
    return;
  }
  visit_forces(row, kin,
               [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                 wrench.col(body).head<3>() += lambda * moment;
                 wrench.col(body).tail<3>() += lambda * force;
               });
}

}  // namespace hagfish
