#include "core/dynamics.hpp"

namespace hagfish {

Matrix6d body_inertia(const Model& model, const Kinematics& kin, int body) {
  const Body& own = model.bodies[body];
  const Eigen::Matrix3d& r = kin.rotation[body];
  return point_operator(r * own.inertia.asDiagonal() * r.transpose(),
                        own.mass * Eigen::Matrix3d::Identity(), kin.centre_offset(body));
}

std::vector<Matrix6d> body_inertias(const Model& model, const Kinematics& kin) {
  std::vector<Matrix6d> inertia(model.bodies.size());
  for (int b = 0; b < model.body_count(); ++b) {
    inertia[b] = body_inertia(model, kin, b);
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

double drag_power(const Model& model, const Kinematics& kin, int body, const Vector6d& twist) {
  const double length = model.bodies[body].length;
  const Eigen::Vector3d along = kin.rotation[body].col(0);
  const Eigen::Vector3d velocity = point_velocity(twist, kin.centre_offset(body));
  const double forward = velocity.dot(along);
  const double sideways = (velocity - forward * along).squaredNorm();
  const double turning = twist.head<3>().cross(along).squaredNorm();
  return length * (model.drag.normal * (sideways + turning * length * length / 12) +
                   model.drag.tangential * forward * forward);
}

Vector6d bias_wrench(const Kinematics& kin, const Matrix6d& inertia, int body) {
  const Vector6d twist = kin.twist.col(body);
  return inertia * kin.bias_twist.col(body) + cross_force(twist, inertia * twist);
}

Matrix6Xd bias_wrench(const Kinematics& kin, const std::vector<Matrix6d>& inertia) {
  Matrix6Xd wrench(6, kin.twist.cols());
  for (int b = 0; b < static_cast<int>(wrench.cols()); ++b) {
    wrench.col(b) = bias_wrench(kin, inertia[b], b);
  }
  return wrench;
}

Vector6d gravity_wrench(const Model& model, const Kinematics& kin, int body) {
  return wrench_of_force(model.bodies[body].mass * model.gravity, kin.centre_offset(body));
}

Matrix6Xd gravity_wrench(const Model& model, const Kinematics& kin) {
  Matrix6Xd wrench(6, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    wrench.col(b) = gravity_wrench(model, kin, b);
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

void assemble_step_system(const Model& model, const State& state, const Kinematics& kin,
                          const TipForce& tip, double h, StepSystem& system) {
  const int n = model.body_count();
  system.inertia.resize(n);
  system.op.inertia.resize(n);
  system.op.diagonal.setZero(model.nv());
  system.wrench.resize(6, n);
  system.joint.setZero(model.nv());
  const bool drag = model.drag.normal != 0 || model.drag.tangential != 0;
  for (int b = 0; b < n; ++b) {
    const Matrix6d inertia = body_inertia(model, kin, b);
    system.inertia[b] = inertia;
    system.op.inertia[b] = inertia;
    if (drag) {
      system.op.inertia[b] += h * drag_operator(model, kin, b);
    }
    system.wrench.col(b) = inertia * kin.twist.col(b) +
                           h * (gravity_wrench(model, kin, b) - bias_wrench(kin, inertia, b));
  }
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    system.op.diagonal[k] = h * hinge.damping + h * h * hinge.stiffness;
    system.joint[k] = -h * hinge.stiffness * state.q[k + 1];
  }

  const int last = n - 1;
  const Eigen::Vector3d offset = kin.centre_offset(last);
  system.wrench.col(last) += h * wrench_of_force(tip.value, offset);
  if (tip.rate != 0) {
    system.op.inertia[last] +=
        point_operator(Eigen::Matrix3d::Zero(), h * tip.rate * Eigen::Matrix3d::Identity(), offset);
  }
}

StepSystem step_system(const Model& model, const State& state, const Kinematics& kin,
                       const TipForce& tip, double h) {
  StepSystem system;
  assemble_step_system(model, state, kin, tip, h, system);
  return system;
}

double kinetic_energy(const Model& model, const Kinematics& kin) {
  double energy = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::Vector3d rate = kin.rotation[b].transpose() * kin.twist.col(b).head<3>();
    energy += 0.5 * (body.mass * kin.centre_velocity.col(b).squaredNorm() +
                     rate.cwiseAbs2().dot(body.inertia));
  }
  return energy;
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
