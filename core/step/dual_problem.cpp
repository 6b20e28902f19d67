#include "core/step/dual_problem.hpp"

namespace hagfish {

void assemble_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                   std::span<const Row> rows, const Eigen::VectorXd& base,
                   const Eigen::Matrix3Xd& centre_velocity, RowColumns& columns, BoxQp& qp) {
  const auto m = static_cast<Eigen::Index>(rows.size());
  columns.reset(model, m);
  qp.b.resize(m);
  qp.lower.resize(m);
  qp.upper.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Row& row = rows[j];
    if (row.dof >= 0) {
      columns.load_joint(row.dof, j, row.sign);
    }
    if (row.beside != 0) {
      columns.load_joint(row.dof + 1, j, row.beside);
    }
    visit_forces(row, [&](int body, const Eigen::Vector3d& force) {
      columns.load(model, body, j, kin.centre_offset(body).cross(force), force);
    });
    qp.b[j] = row.rhs - row_velocity(row, centre_velocity, base);
    qp.lower[j] = row.lower;
    qp.upper[j] = row.upper;
  }
  factor.half_solve(model, kin, columns);
  columns.gram(qp.A);
}

BoxQp whole_dual(const Model& model, const Kinematics& kin, const StepSystem& system,
                 std::span<const Row> rows) {
  ArticulatedFactor factor;
  factor.factorise(model, kin, system.op);
  const Eigen::VectorXd base = factor.solve(model, kin, system.wrench, system.joint);
  RowColumns columns;
  BoxQp qp;
  assemble_dual(model, kin, factor, rows, base,
                centre_velocities(kin, body_twists(model, kin, base)), columns, qp);
  return qp;
}

}  // namespace hagfish
