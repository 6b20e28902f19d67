#include "core/dual_problem.hpp"

namespace hagfish {

DualProblem::DualProblem(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                         const Eigen::VectorXd& unconstrained)
    : model_(model),
      kin_(kin),
      factor_(factor),
      unconstrained_(unconstrained),
      twist_(body_twists(model, kin, unconstrained)) {}

double DualProblem::excess_unconstrained(const Row& row) const {
  return row_velocity(row, kin_, twist_, unconstrained_) - row.rhs;
}

BoxQp DualProblem::assemble(const std::vector<Row>& rows) const {
  const auto m = static_cast<Eigen::Index>(rows.size());
  ColumnSet columns{Columns::Zero(model_.nv(), m), Columns::Zero(6 * model_.body_count(), m)};
  for (Eigen::Index j = 0; j < m; ++j) {
    const Row& row = rows[j];
    if (row.dof >= 0) {
      columns.joint(row.dof, j) = row.sign;
    }
    for (int k = 0; k < row.forces; ++k) {
      const auto& [body, force] = row.force[k];
      columns.body.col(j).segment<6>(6 * body) += wrench_of_force(force, kin_.centre_offset(body));
    }
  }
  factor_.solve(model_, kin_, columns);
  BoxQp qp;
  qp.A.setZero(m, m);
  qp.b.resize(m);
  qp.lower.resize(m);
  qp.upper.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Row& row = rows[i];
    if (row.dof >= 0) {
      qp.A.row(i) = row.sign * columns.joint.row(row.dof);
    }
    for (int k = 0; k < row.forces; ++k) {
      const auto& [body, force] = row.force[k];
      const Vector6d wrench = wrench_of_force(force, kin_.centre_offset(body));
      qp.A.row(i).noalias() += wrench.transpose() * columns.body.middleRows<6>(6 * body);
    }
    qp.b[i] = -excess_unconstrained(row);
    qp.lower[i] = row.lower;
    qp.upper[i] = row.upper;
  }
  qp.A = (0.5 * (qp.A + qp.A.transpose())).eval();
  return qp;
}

}  // namespace hagfish
