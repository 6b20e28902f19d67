#include "core/step/paper_step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hagfish {

Matrix6Xd body_jacobian(const Model& model, const Kinematics& kin, int body) {
  Matrix6Xd jacobian = Matrix6Xd::Zero(6, model.nv());
  const int ahead = model.bodies[body].first_dof + model.bodies[body].dofs;
  jacobian.leftCols(ahead) = kin.axis.leftCols(ahead);
  return jacobian;
}

Eigen::Matrix3Xd centre_jacobian(const Model& model, const Kinematics& kin, int body) {
  const Eigen::Vector3d offset = kin.centre_offset(body);
  const Matrix6Xd jacobian = body_jacobian(model, kin, body);
  Eigen::Matrix3Xd velocity = jacobian.bottomRows<3>();
  for (Eigen::Index k = 0; k < velocity.cols(); ++k) {
    velocity.col(k) += jacobian.col(k).head<3>().cross(offset);
  }
  return velocity;
}

Eigen::MatrixXd dense_rows(const Model& model, const Kinematics& kin,
                           const std::vector<Row>& rows) {
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), model.nv());
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Row& row = rows[i];
    if (const OnJoint* joint = row.joint()) {
      c(i, joint->dof) = joint->sign;
      if (!row.unit()) c(i, joint->dof + 1) = joint->next_sign;
    }
    visit_forces(row, kin,
                 [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                   const Matrix6Xd jacobian = body_jacobian(model, kin, body);
                   c.row(i) += moment.transpose() * jacobian.topRows<3>() +
                               force.transpose() * jacobian.bottomRows<3>();
                 });
  }
  return c;
}

namespace {

/// Eq. 1, H q̇* = M q̇0 + h f, with H = M + h D - h² K: springs, damping and drag are implicit.
void paper_equation_1(const StepInput& in, const StepPlace& place, PrimalQp& qp) {
  const Model& model = in.model;
  const State& state = in.state;
  const Control& control = in.control;
  const Kinematics& kin = place.kin;
  const double h = in.scene.time.reach();
  const double ring = in.scene.time.spring_damping();
  const int nv = model.nv();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(nv, nv);
  Eigen::MatrixXd D = M;
  Eigen::MatrixXd K = M;
  Eigen::VectorXd f = stiffness_force(model, state.q);
  const Matrix6Xd on_bodies = gravity_wrench(model, kin) - bias_wrench(model, kin, place.motion);
  for (int b = 0; b < model.body_count(); ++b) {
    const Matrix6Xd J = body_jacobian(model, kin, b);
    M += J.transpose() * body_inertia(model, kin, b) * J;
    D += J.transpose() * drag_operator(model, kin, b) * J;
    f += J.transpose() * on_bodies.col(b);
  }
  for (int k = root_dofs; k < nv; ++k) {
    const double stiffness = model.hinges[k - root_dofs].stiffness;
    D(k, k) += model.hinges[k - root_dofs].damping + 2 * ring * stiffness;
    f[k] += ring * stiffness * state.qdot[k];
    K(k, k) = -stiffness;
  }
  const Eigen::Matrix3Xd J = centre_jacobian(model, kin, control.tip.on(model));
  D += control.tip.rate * J.transpose() * J;
  f += J.transpose() * control.tip.value;
  for (const ActiveTorque* torque : {&control.active, &control.torque}) {
    if (torque->value.size() > 0) {
      D += torque->rate.asDiagonal();
      f += torque->value;
    }
  }
  qp.H = M + h * D - h * h * K;
  qp.g = M * state.qdot + h * f;
}

/// A flesh row C v + c λ >= d is C v + s >= d with a velocity s of its own, at the price ½ s²/c.
void add_yields(const std::vector<Row>& unilateral, PrimalQp& qp) {
  for (Eigen::Index i = 0; i < qp.d.size(); ++i) {
    const double compliance = unilateral[i].compliance;
    if (compliance == 0) continue;
    const Eigen::Index n = qp.g.size();
    qp.H.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
    qp.g.conservativeResizeLike(Eigen::VectorXd::Zero(n + 1));
    qp.G.conservativeResizeLike(Eigen::MatrixXd::Zero(qp.G.rows(), n + 1));
    qp.C.conservativeResizeLike(Eigen::MatrixXd::Zero(qp.C.rows(), n + 1));
    qp.H(n, n) = 1 / compliance;
    qp.C(i, n) = 1;
  }
}

}  // namespace

PrimalQp paper_problem(const StepInput& in, const StepPlace& place, const std::vector<Row>& rows) {
  PrimalQp qp;
  paper_equation_1(in, place, qp);
  std::vector<Row> bilateral, unilateral;
  for (const Row& row : rows) (std::isinf(row.lower) ? bilateral : unilateral).push_back(row);
  const auto column = [](const std::vector<Row>& of, double Row::*member) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(of.size()));
    std::ranges::transform(of, values.begin(), member);
    return values;
  };
  qp.G = dense_rows(in.model, place.kin, bilateral);
  qp.e = column(bilateral, &Row::rhs);
  qp.C = dense_rows(in.model, place.kin, unilateral);
  qp.d = column(unilateral, &Row::rhs);
  qp.cap = column(unilateral, &Row::upper);
  add_yields(unilateral, qp);
  return qp;
}

State paper_step(const StepInput& in, const std::vector<Row>& rows,
                 const std::function<Eigen::VectorXd(const PrimalQp&)>& solve) {
  const PrimalQp qp = paper_problem(in, start_of(in), rows);
  const Eigen::Index n = qp.g.size();
  const Eigen::Index p = qp.e.size();
  Eigen::VectorXd v;
  if (rows.empty()) {
    v = qp.H.llt().solve(qp.g);  // Eq. 1: H q̇* = g
  } else if (qp.d.size() == 0) {
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + p, n + p);  // Eq. 3
    kkt << qp.H, qp.G.transpose(), qp.G, Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd right(n + p);
    right << qp.g, qp.e;
    v = kkt.partialPivLu().solve(right).head(n);
  } else {
    v = solve(qp);  // Eq. 4: min ½ v'Hv - g'v, Gv = e, Cv >= d
  }
  v.conservativeResize(in.model.nv());
  return {advance(in.state.q, v, in.scene.time.step), v};  // Eq. 2
}

}  // namespace hagfish
