#include "core/step/dual_problem.hpp"

#include <Eigen/Cholesky>

namespace hagfish {
namespace {

/// A_ii of a row between points, times the mass of a body that it acts on, is below this where
/// prescribed velocities keep these points from moving against each other: then it is rounding,
/// some 1e-32. Where they move at all it is far above.
constexpr double immovable = 1e-20;

/// Makes A 0 for those of `rows`, which begin at `first`, that cannot move: the solver would take
/// rounding for a way to move them.
void clear_immovable(const Model& model, std::span<const Row> rows, Eigen::Index first,
                     Eigen::MatrixXd& A) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Eigen::Index i = first + static_cast<Eigen::Index>(k);
    if (rows[k].dof < 0 && A(i, i) * model.bodies[rows[k].a.first].mass < immovable) {
      A.row(i).setZero();
      A.col(i).setZero();
    }
  }
}

void load_row(const Model& model, const Kinematics& kin, const Row& row, Eigen::Index column,
              RowColumns& columns) {
  if (row.dof >= 0) {
    columns.load_joint(row.dof, column, row.sign);
  }
  if (row.beside != 0) {
    columns.load_joint(row.dof + 1, column, row.beside);
  }
  visit_forces(row, kin,
               [&](int body, const Eigen::Vector3d& force, const Eigen::Vector3d& offset) {
                 columns.load(model, body, column, offset.cross(force), force);
               });
}

/// C of one row at one velocity.
double coefficient(const Model& model, const Kinematics& kin, const Row& row, int dof) {
  if (row.dof >= 0) {
    return row.dof == dof ? row.sign : (row.dof + 1 == dof ? row.beside : 0);
  }
  double sum = 0;
  visit_forces(row, kin,
               [&](int body, const Eigen::Vector3d& force, const Eigen::Vector3d& offset) {
                 if (dof < model.bodies[body].first_dof + model.bodies[body].dofs) {
                   const auto axis = kin.axis.col(dof);
                   sum += axis.head<3>().dot(offset.cross(force)) + axis.tail<3>().dot(force);
                 }
               });
  return sum;
}

/// Right-hand side and bounds of row `i` of a problem.
void set_row(const Row& row, const Eigen::VectorXd& base, const BodyVelocities& bodies,
             Eigen::Index i, BoxQp& qp) {
  qp.b[i] = row.rhs - row_velocity(row, bodies, base);
  qp.lower[i] = row.lower;
  qp.upper[i] = row.upper;
}

/// Takes what released velocities answer into the problem, whose other rows are set.
void release(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
             const ExtendedRows& rows, DualExtension& e) {
  const auto there = static_cast<Eigen::Index>(rows.there.size());
  const auto added = static_cast<Eigen::Index>(rows.added.size());
  const auto released = static_cast<Eigen::Index>(rows.released.size());
  const Eigen::Index unreleased = there + added;
  const Eigen::Index m = unreleased + released;
  // U: how the rows move with a unit velocity of each released one. With K s = λ - reaction +
  // U'λ' the released velocities s go with the forces λ' of the other rows and λ of their own, so
  // that [U; 1] K⁻¹ [U; 1]' comes on top of A.
  factor.free_inertia(kin, e.columns, e.inertia);
  Eigen::Ref<Eigen::MatrixXd> in_place(e.inertia);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> inertia_factor(in_place);
  e.answer.resize(m + 1, released);
  for (Eigen::Index r = 0; r < released; ++r) {
    const Row& own = rows.released[r];
    for (Eigen::Index i = 0; i < there; ++i) {
      e.answer(i, r) =
          own.sign * coefficient(model, kin, rows.there[i], own.dof) - e.cross(i, added + r);
    }
    for (Eigen::Index i = 0; i < added; ++i) {
      e.answer(there + i, r) =
          own.sign * coefficient(model, kin, rows.added[i], own.dof) - e.own(i, added + r);
    }
    e.qp.lower[unreleased + r] = own.lower;
    e.qp.upper[unreleased + r] = own.upper;
  }
  e.answer.middleRows(unreleased, released).setIdentity();
  e.answer.bottomRows<1>() = e.reaction.transpose();
  inertia_factor.matrixU().solveInPlace<Eigen::OnTheRight>(e.answer);
  // With K = L L' the rows of the problem in `answer` are [U; 1] L'⁻¹ now, the last one L⁻¹ times
  // the reactions.
  const auto half = e.answer.topRows(m);
  e.qp.A.rightCols(released).setZero();
  e.qp.A.bottomRows(released).setZero();
  e.qp.A += half.lazyProduct(half.transpose());
  e.qp.b.tail(released).setZero();
  e.qp.b += half.lazyProduct(e.answer.bottomRows<1>().transpose());
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
    set_row(row, base, bodies, j, qp);
  }
  factor.half_solve(model, kin, columns);
  columns.gram(qp.A);
  clear_immovable(model, rows, 0, qp.A);
}

void extend_dual(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                 const ExtendedRows& rows, const Eigen::VectorXd& base,
                 const BodyVelocities& bodies, const RowColumns& columns, const BoxQp& qp,
                 DualExtension& extension) {
  const auto there = static_cast<Eigen::Index>(rows.there.size());
  const auto added = static_cast<Eigen::Index>(rows.added.size());
  const auto released = static_cast<Eigen::Index>(rows.released.size());
  DualExtension& e = extension;
  e.columns.reset(model, added + released);
  for (Eigen::Index j = 0; j < added; ++j) {
    load_row(model, kin, rows.added[j], j, e.columns);
  }
  for (Eigen::Index r = 0; r < released; ++r) {
    e.columns.load_motion(model, rows.released[r].dof, added + r, rows.released[r].sign);
  }
  factor.half_solve(model, kin, e.columns);
  columns.products(e.columns, e.cross);
  e.columns.gram(e.own);

  const Eigen::Index m = there + added + released;
  e.qp.A.resize(m, m);
  e.qp.A.topLeftCorner(there, there) = qp.A;
  e.qp.A.block(0, there, there, added) = e.cross.leftCols(added);
  e.qp.A.block(there, 0, added, there) = e.cross.leftCols(added).transpose();
  e.qp.A.block(there, there, added, added) = e.own.topLeftCorner(added, added);
  e.qp.b.resize(m);
  e.qp.b.head(there) = qp.b;
  e.qp.lower.resize(m);
  e.qp.upper.resize(m);
  e.qp.lower.head(there) = qp.lower;
  e.qp.upper.head(there) = qp.upper;
  for (Eigen::Index j = 0; j < added; ++j) {
    set_row(rows.added[j], base, bodies, there + j, e.qp);
  }
  if (released > 0) {
    release(model, kin, factor, rows, e);
  }
  clear_immovable(model, rows.there, 0, e.qp.A);
  clear_immovable(model, rows.added, there, e.qp.A);
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
