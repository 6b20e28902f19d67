#include "core/step/rows/dual_problem.hpp"

namespace hagfish {
namespace {

/// Where prescribed velocities keep the two points of a row from moving against each other, A_ii
/// times the mass of a body of the row is rounding, about 1e-32. Where the points can move it is
/// far above this bound.
constexpr double immovable = 1e-20;

/// Sets A to 0 for those of `rows` that cannot move, since the solver would take rounding for a way
/// to move them.
void clear_immovable(const Model& model, std::span<const Row> rows, Eigen::MatrixXd& A) {
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    if (rows[i].joint() == nullptr &&
        A(i, i) * model.bodies[rows[i].points().a.first].mass < immovable) {
      A.row(i).setZero();
      A.col(i).setZero();
    }
  }
}

void load_row(const Model& model, const Kinematics& kin, const Row& row, Eigen::Index column,
              RowColumns& columns) {
  if (const OnJoint* joint = row.joint()) {
    columns.load_joint(joint->dof, column, joint->sign);
    if (!row.unit()) columns.load_joint(joint->dof + 1, column, joint->next_sign);
    return;
  }
  visit_forces(row, kin,
               [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                 columns.load(model, body, column, moment, force);
               });
}

}  // namespace

void assemble_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                   std::span<const Row> rows, const Eigen::VectorXd& base,
                   const BodyVelocities& bodies, RowColumns& columns, BoxQp& qp) {
  const auto m = static_cast<Eigen::Index>(rows.size());
  columns.reset(model, m);
  qp.b.resize(m);
  qp.lower.resize(m);
  qp.upper.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Row& row = rows[j];
    load_row(model, kin, row, j, columns);
    qp.b[j] = row.rhs - row_velocity(row, bodies, base);
    qp.lower[j] = row.lower;
    qp.upper[j] = row.upper;
  }
  factor.half_solve(model, kin, columns);
  columns.gram(qp.A);
  clear_immovable(model, rows, qp.A);
  for (Eigen::Index i = 0; i < m; ++i) qp.A(i, i) += rows[i].compliance;
}

BoxQp whole_dual(const Model& model, const Kinematics& kin, const StepSystem& system,
                 std::span<const Row> rows) {
  ArticulatedFactor factor;
  factor.factorise(model, kin, system.op);
  const Eigen::VectorXd base = factor.solve(model, kin, system.wrench, system.joint);
  const Matrix6Xd twist = body_twists(model, kin, base);
  RowColumns columns;
  BoxQp qp;
  assemble_dual(model, kin, factor, rows, base, {twist, centre_velocities(kin, twist)}, columns,
                qp);
  return qp;
}

}  // namespace hagfish
