// The dual problem against A = C H⁻¹ C' and b = d - C q̇* of dense matrices.
#include "core/step/rows/dual_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>

#include "core/contact/contact.hpp"
#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::dual_problem_test {

constexpr double h = 0.002;
/// Of sums over 100 bodies through H, whose condition is 1.4e6: 1e-16 times that.
constexpr double rounding = 1e-9;

/// The hagfish along a trefoil that touches itself, in motion and pulled at the tail: rows of every
/// kind, each with a right-hand side.
struct Knotted {
  Knotted() {
    scene.controller.cap = 300;
    state = knotted_state(random, model, 2.45, 0.01);
    state.qdot = random_entries(random, model.nv());
    kin = kinematics(model, state);
    system = step_system(model, state, kin, {{100, -200, 50}, 3}, h);
    const ContactSet contacts = find_contacts(spline(model, kin.centre), scene.contact);
    rows = head_rows(state, scene.constraints, h);
    append(thigmotaxis_rows(model,
                            {{contacts.contacts.front(), {2, 1}}, {contacts.contacts.back(), {}}},
                            scene.controller, kin, h));
    append(contact_rows(model, contacts, scene.constraints, h));
    append(limit_rows(model, state, scene.constraints, h));
    append(plane_rows(model, kin, scene.constraints, h));
  }
  void append(const std::vector<Row>& more) { rows.insert(rows.end(), more.begin(), more.end()); }

  Eigen::VectorXd rhs() const {
    Eigen::VectorXd d(static_cast<Eigen::Index>(rows.size()));
    std::ranges::transform(rows, d.begin(), &Row::rhs);
    return d;
  }

  Random random{11};
  Scene scene = table1_scene();
  Model model = cone_hagfish();  // whose limits are rows on two velocities
  State state;
  Kinematics kin;
  StepSystem system;
  std::vector<Row> rows;
};

/// The problem of `rows` where velocities are prescribed; `base` is the velocity without the rows.
BoxQp dual_with(const Knotted& k, const std::vector<PrescribedVelocity>& prescribed,
                const std::vector<Row>& rows, Eigen::VectorXd& base) {
  ArticulatedFactor factor;
  factor.factorise(k.model, k.kin, k.system.op, prescribed);
  Eigen::VectorXd reaction;
  Matrix6Xd twist;
  factor.solve(k.model, k.kin, k.system.wrench, k.system.joint, base, twist, reaction);
  RowColumns columns;
  BoxQp qp;
  assemble_dual(k.model, k.kin, factor, rows, base, {twist, centre_velocities(k.kin, twist)},
                columns, qp);
  return qp;
}

TEST(DualProblem, IsTheDenseOneOfAllRowsInAnyOrder) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Knotted k;
  std::set<RowKind> kinds;
  for (const Row& row : k.rows) kinds.insert(row.kind);
  ASSERT_EQ(kinds.size(), row_kinds.size());
  const Eigen::LLT<Eigen::MatrixXd> factor(dense(k.model, k.kin, k.system.op));
  const Eigen::VectorXd g = generalised_force(k.model, k.kin, k.system.wrench) + k.system.joint;
  for (int order = 0; order < 2; ++order) {
    const BoxQp qp = whole_dual(k.model, k.kin, k.system, k.rows);
    const Eigen::MatrixXd C = dense_rows(k.model, k.kin, k.rows);
    EXPECT_LE(relative_error(qp.A, C * factor.solve(C.transpose())), rounding);
    EXPECT_LE(relative_error(qp.b, k.rhs() - C * factor.solve(g)), rounding);
    EXPECT_EQ(qp.A, qp.A.transpose());
    ASSERT_EQ(qp.lower.size(), C.rows());
    for (Eigen::Index i = 0; i < C.rows(); ++i) {
      const RowKind kind = k.rows[static_cast<std::size_t>(i)].kind;
      EXPECT_EQ(qp.lower[i], kind == RowKind::head ? -infinity : 0);
      EXPECT_EQ(qp.upper[i], kind == RowKind::thigmotaxis ? 300 * h : infinity);
    }
    std::ranges::shuffle(k.rows, k.random);
  }
}

TEST(DualProblem, PrescribedVelocitiesDoNotAnswer) {
  Knotted k;
  k.rows.erase(k.rows.begin(), k.rows.begin() + root_dofs);  // prescribed in place of rows
  std::vector<PrescribedVelocity> prescribed;
  std::vector<Eigen::Index> free;
  for (int dof = 0; dof < k.model.nv(); ++dof) {
    if (dof < root_dofs || dof % 5 == 0) {
      prescribed.push_back({dof, 0.1 * dof});
    } else {
      free.push_back(dof);
    }
  }
  Eigen::VectorXd base;
  const BoxQp qp = dual_with(k, prescribed, k.rows, base);
  const Eigen::MatrixXd H = dense(k.model, k.kin, k.system.op)(free, free);
  const Eigen::MatrixXd C = dense_rows(k.model, k.kin, k.rows);
  const Eigen::MatrixXd moving = C(Eigen::all, free);
  EXPECT_LE(relative_error(qp.A, moving * H.llt().solve(moving.transpose())), rounding);
  EXPECT_LE(relative_error(qp.b, k.rhs() - C * base), rounding);
}

TEST(DualProblem, RowsThatPrescribedVelocitiesHoldCannotMove) {
  const Knotted k;
  std::vector<Row> contacts;  // within a body of which no joint moves
  std::ranges::copy_if(k.rows, std::back_inserter(contacts),
                       [](const Row& row) { return row.kind == RowKind::contact; });
  ASSERT_GE(contacts.size(), 2U);
  const auto A_where = [&](const auto& is_prescribed) {
    std::vector<PrescribedVelocity> prescribed;
    for (int dof = root_dofs; dof < k.model.nv(); ++dof) {
      if (is_prescribed(dof)) prescribed.push_back({dof, 0.1 * dof});
    }
    Eigen::VectorXd base;
    return dual_with(k, prescribed, contacts, base).A;
  };
  const auto count = static_cast<Eigen::Index>(contacts.size());
  EXPECT_EQ(A_where([](int) { return true; }), Eigen::MatrixXd::Zero(count, count))
      << "which was some 1e-33";
  // They move where a joint between their points does.
  const int between = k.model.bodies[contacts[0].points().b.first].first_dof;
  EXPECT_GT(A_where([&](int dof) { return dof != between; })(0, 0), 1e-6);
}

TEST(DualProblem, StorageOfALargerOneServesASmallerOne) {
  const Knotted k;
  ArticulatedFactor factor;
  factor.factorise(k.model, k.kin, k.system.op);
  const Eigen::VectorXd base = factor.solve(k.model, k.kin, k.system.wrench, k.system.joint);
  const Matrix6Xd twist = body_twists(k.model, k.kin, base);
  const Eigen::Matrix3Xd velocity = centre_velocities(k.kin, twist);
  RowColumns columns;
  BoxQp qp;
  for (const std::size_t count : {k.rows.size(), std::size_t{9}, std::size_t{0}}) {
    const std::vector<Row> rows(k.rows.begin(), k.rows.begin() + static_cast<long>(count));
    assemble_dual(k.model, k.kin, factor, rows, base, {twist, velocity}, columns, qp);
    const BoxQp fresh = whole_dual(k.model, k.kin, k.system, rows);
    EXPECT_EQ(qp.A, fresh.A) << count;
    EXPECT_EQ(qp.b, fresh.b);
    EXPECT_EQ(qp.lower, fresh.lower);
    EXPECT_EQ(qp.upper, fresh.upper);
  }
}

}  // namespace hagfish::dual_problem_test
