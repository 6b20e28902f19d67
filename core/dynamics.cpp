#include "core/dynamics.hpp"

namespace hagfish {

std::vector<Matrix6d> body_inertias(const Model& model, const Kinematics& kin) {
  std::vector<Matrix6d> inertia(model.bodies.size());
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::Matrix3d& r = kin.rotation[b];
    inertia[b] = point_operator(r * body.inertia.asDiagonal() * r.transpose(),
                                body.mass * Eigen::Matrix3d::Identity(), kin.centre_offset(b));
  }
  return inertia;
}

Matrix6d drag_operator(const Model& model, const Kinematics& kin, int body) {
  const double length = model.bodies[body].length;
  const Eigen::Vector3d along = kin.rotation[body].col(0);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along * along.transpose();
  // A rod that turns about its centre meets normal drag alone, at x times the rate: ∫ x² dx.
  const double turning = model.drag.normal * length * length * length / 12;
  return point_operator(
      turning * across,
      length * (model.drag.normal * across + model.drag.tangential * along * along.transpose()),
      kin.centre_offset(body));
}

Eigen::VectorXd drag_force(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v) {
  Matrix6Xd wrench = body_twists(model, kin, v);
  for (int b = 0; b < model.body_count(); ++b) {
    wrench.col(b) = -(drag_operator(model, kin, b) * wrench.col(b)).eval();
  }
  return generalised_force(model, kin, wrench);
}

Matrix6Xd bias_wrench(const Kinematics& kin, const std::vector<Matrix6d>& inertia) {
  Matrix6Xd wrench(6, kin.twist.cols());
  for (Eigen::Index b = 0; b < wrench.cols(); ++b) {
    const Vector6d momentum = inertia[b] * kin.twist.col(b);
    wrench.col(b) = inertia[b] * kin.bias_twist.col(b) + cross_force(kin.twist.col(b), momentum);
  }
  return wrench;
}

Matrix6Xd gravity_wrench(const Model& model, const Kinematics& kin) {
  Matrix6Xd wrench(6, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    wrench.col(b) = wrench_of_force(model.bodies[b].mass * model.gravity, kin.centre_offset(b));
  }
  return wrench;
}

Eigen::VectorXd stiffness_force(const Model& model, const Eigen::VectorXd& q) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(model.nv());
  for (int k = root_dofs; k < model.nv(); ++k) {
    force[k] = -model.hinges[k - root_dofs].stiffness * q[k + 1];
  }
  return force;
}

StepSystem step_system(const Model& model, const State& state, const Kinematics& kin,
                       const TipForce& tip, double h) {
  StepSystem system;
  system.inertia = body_inertias(model, kin);
  system.op.inertia = system.inertia;
  system.op.diagonal = Eigen::VectorXd::Zero(model.nv());
  const bool drag = model.drag.normal != 0 || model.drag.tangential != 0;
  for (int b = 0; drag && b < model.body_count(); ++b) {
    system.op.inertia[b] += h * drag_operator(model, kin, b);
  }
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    system.op.diagonal[k] = h * hinge.damping + h * h * hinge.stiffness;
  }

  system.wrench = h * (gravity_wrench(model, kin) - bias_wrench(kin, system.inertia));
  for (int b = 0; b < model.body_count(); ++b) {
    system.wrench.col(b) += system.inertia[b] * kin.twist.col(b);
  }
  system.joint = h * stiffness_force(model, state.q);

  const int last = model.body_count() - 1;
  const Eigen::Vector3d offset = kin.centre_offset(last);
  system.wrench.col(last) += h * wrench_of_force(tip.value, offset);
  if (tip.rate != 0) {
    system.op.inertia[last] +=
        point_operator(Eigen::Matrix3d::Zero(), h * tip.rate * Eigen::Matrix3d::Identity(), offset);
  }
  return system;
}

double kinetic_energy(const std::vector<Matrix6d>& inertia, const Matrix6Xd& twist) {
  double energy = 0;
  for (Eigen::Index b = 0; b < twist.cols(); ++b) {
    energy += 0.5 * twist.col(b).dot(inertia[b] * twist.col(b));
  }
  return energy;
}

double elastic_energy(const Model& model, const Eigen::VectorXd& q) {
  double energy = 0;
  for (int k = root_dofs; k < model.nv(); ++k) {
    energy += 0.5 * model.hinges[k - root_dofs].stiffness * q[k + 1] * q[k + 1];
  }
  return energy;
}

double gravity_energy(const Model& model, const Kinematics& kin) {
  double energy = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    energy -= model.bodies[b].mass * model.gravity.dot(kin.centre.col(b));
  }
  return energy;
}

}  // namespace hagfish
