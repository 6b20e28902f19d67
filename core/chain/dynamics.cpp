#include "core/chain/dynamics.hpp"

#include <algorithm>

#include "core/chain/sines.hpp"

namespace hagfish {
namespace {

/// About the centre, world axes, g cm^2.
Eigen::Matrix3d angular_inertia(const Model& model, const Kinematics& kin, int body) {
  const Eigen::Matrix3d& r = kin.rotation[body];
  return r * model.bodies[body].inertia.asDiagonal() * r.transpose();
}

/// The same about O, from which the centre is at `offset`.
template <class Column>
void put_about_reference(const CentreWrench& wrench, const Eigen::Vector3d& offset,
                         Column&& column) {
  column.template head<3>() = wrench.moment + offset.cross(wrench.force);
  column.template tail<3>() = wrench.force;
}

/// A symmetric operator on the angular velocity and on the velocity of the body's centre.
struct CentreOperator {
  Eigen::Matrix3d angular, linear;
};

/// Water drag of one body, dyn cm s and dyn s / cm.
CentreOperator drag_at_centre(const Model& model, const Kinematics& kin, int body) {
  const double length = model.bodies[body].length;
  const Eigen::Vector3d along = kin.rotation[body].col(0);
  const Eigen::Matrix3d forward = along * along.transpose();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - forward;
  // A rod that turns about its centre moves across itself at x times the rate: ∫ x² dx.
  const double turning = model.drag.normal * length * length * length / 12;
  return {turning * across,
          length * model.drag.normal * across + length * model.drag.tangential * forward};
}

/// As point_operator of both about the centre, which is at `offset` from O; `linear` has no side.
/// Written in place, entry by entry: a copy would wait for its bytes.
void put_centre_operator(const AxisOperator& angular, const AxisOperator& linear,
                         const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset,
                         PaddedOperator& put_in) {
  const Eigen::Vector3d a = axes.col(0);
  const Eigen::Vector3d s = axes.col(1);
  const Eigen::Vector3d c = offset.cross(a);
  const Eigen::Vector3d along = angular.along * a;
  const Eigen::Vector3d side = angular.side * s;
  const Eigen::Vector3d lever = linear.along * c;
  const Eigen::Vector3d first = linear.plain * offset;
  const Eigen::Vector3d forward = linear.along * a;
  const double plain = angular.plain + first.dot(offset);
  auto& m = put_in.columns;
  const auto put = [&m](int i, int j, double value) {
    m(i, j) = value;
    m(j, i) = value;
  };
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      put(i, j,
          along[i] * a[j] + side[i] * s[j] - first[i] * offset[j] + lever[i] * c[j] +
              (i == j ? plain : 0));
      put(3 + i, 3 + j, forward[i] * a[j] + (i == j ? linear.plain : 0));
    }
    // [offset] linear
    const int next = (j + 1) % 3;
    const int last = (j + 2) % 3;
    put(j, 3 + j, lever[j] * a[j]);
    put(j, 3 + next, lever[j] * a[next] - first[last]);
    put(j, 3 + last, lever[j] * a[last] + first[next]);
  }
}

/// Inertial wrench of one body at q̈ = 0, about its centre: the rate of its momentum at
/// motion.mean_twist as it moves by kin.twist.
inline CentreWrench bias_at_centre(const Model& model, const Kinematics& kin,
                                   const StepMotion& motion, int body) {
  const AxisOperator inertia = inertia_about_centre(model.bodies[body]);
  const double mass = model.bodies[body].mass;
  const Eigen::Matrix3d& axes = kin.rotation[body];
  const Eigen::Vector3d offset = kin.centre_offset(body);
  const Eigen::Vector3d bias = kin.bias_twist.col(body).head<3>();
  const Eigen::Vector3d bias_at_reference = kin.bias_twist.col(body).tail<3>();
  const Eigen::Vector3d turn = kin.twist.col(body).head<3>();
  const Eigen::Vector3d shift = kin.centre_velocity.col(body);
  const Eigen::Vector3d spin = motion.mean_twist.col(body).head<3>();
  const Eigen::Vector3d angular = inertia.times(axes, spin);
  const Eigen::Vector3d acceleration = bias_at_reference + bias.cross(offset) + spin.cross(shift);
  CentreWrench wrench{inertia.times(axes, bias - turn.cross(spin)) + turn.cross(angular),
                      mass * acceleration};
  if (motion.bias_power != nullptr) {
    const BiasPower& power = *motion.bias_power;
    const Eigen::Vector3d seen = shift - power.observer;
    const Eigen::Vector3d linear =
        mass * (point_velocity(motion.mean_twist.col(body), offset) - power.observer);
    const double work = std::max(angular.dot(turn) + linear.dot(seen), power.least);
    const double missing = power.value[body] - wrench.moment.dot(turn) - wrench.force.dot(seen);
    const double share = work > 0 ? missing / work : 0;
    wrench.moment += share * angular;
    wrench.force += share * linear;
  }
  return wrench;
}

}  // namespace

Matrix6d body_inertia(const Model& model, const Kinematics& kin, int body) {
  return point_operator(angular_inertia(model, kin, body),
                        model.bodies[body].mass * Eigen::Matrix3d::Identity(),
                        kin.centre_offset(body));
}

std::vector<PaddedOperator> body_inertias(const Model& model, const Kinematics& kin) {
  std::vector<PaddedOperator> inertia(model.bodies.size());
  for (int b = 0; b < model.body_count(); ++b) inertia[b] = body_inertia(model, kin, b);
  return inertia;
}

Matrix6d drag_operator(const Model& model, const Kinematics& kin, int body) {
  const CentreOperator drag = drag_at_centre(model, kin, body);
  return point_operator(drag.angular, drag.linear, kin.centre_offset(body));
}

Eigen::VectorXd drag_force(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v) {
  Matrix6Xd wrench = body_twists(model, kin, v);
  for (int b = 0; b < model.body_count(); ++b) {
    wrench.col(b) = -(drag_operator(model, kin, b) * wrench.col(b)).eval();
  }
  return generalised_force(model, kin, wrench);
}

Matrix6Xd bias_wrench(const Model& model, const Kinematics& kin, const StepMotion& motion) {
  Matrix6Xd wrench(6, kin.twist.cols());
  for (int b = 0; b < model.body_count(); ++b) {
    put_about_reference(bias_at_centre(model, kin, motion, b), kin.centre_offset(b), wrench.col(b));
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

Eigen::VectorXd ring_damping_force(const Model& model, double damping,
                                   const Eigen::VectorXd& before,
                                   const Eigen::VectorXd& mean_velocity) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(model.nv());
  for (int k = root_dofs; k < model.nv(); ++k) {
    force[k] =
        -damping * model.hinges[k - root_dofs].stiffness * (2 * mean_velocity[k] - before[k]);
  }
  return force;
}

void assemble_step_system(const Model& model, const State& state, const StepMotion& motion,
                          const Kinematics& kin, const TipForce& tip, const ForceTiming& when,
                          StepSystem& system) {
  const double h = when.reach;
  const int n = model.body_count();
  system.bias.resize(6, n);
  system.op.inertia.resize(n);
  system.op.diagonal.setZero(model.nv());
  system.wrench.resize(6, n);
  system.joint.setZero(model.nv());
  for (int b = 0; b < n; ++b) {
    const Body& body = model.bodies[b];
    const Eigen::Vector3d offset = kin.centre_offset(b);
    const Eigen::Matrix3d& axes = kin.rotation[b];
    const AxisOperator inertia = inertia_about_centre(body);
    // Drag as drag_at_centre has it.
    const double sideways = h * body.length * model.drag.normal;
    const double forward = h * body.length * model.drag.tangential;
    const double turning = sideways * body.length * body.length / 12;
    put_centre_operator({inertia.plain + turning, inertia.along - turning, inertia.side},
                        {body.mass + sideways, forward - sideways}, axes, offset,
                        system.op.inertia[b]);
    const CentreWrench bias = bias_at_centre(model, kin, motion, b);
    system.bias.col(b).head<3>() = bias.moment;
    system.bias.col(b).tail<3>() = bias.force;
    const Eigen::Vector3d spin = motion.twist.col(b).head<3>();
    put_about_reference(
        {inertia.times(axes, spin) - h * bias.moment,
         body.mass * motion.centre_velocity.col(b) + h * (body.mass * model.gravity - bias.force)},
        offset, system.wrench.col(b));
  }
  // Springs at x, and their numerical damping at 2 x - v: -K (q + h x) - β K (2 x - v).
  const double spring_reach = h + 2 * when.spring_damping;
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    system.op.diagonal[k] = h * hinge.damping + h * spring_reach * hinge.stiffness;
    system.joint[k] = -h * hinge.stiffness * (state.q[k + 1] - when.spring_damping * state.qdot[k]);
  }

  const int pulled = tip.on(model);
  const Eigen::Vector3d offset = kin.centre_offset(pulled);
  system.wrench.col(pulled) += h * wrench_of_force(tip.value, offset);
  if (tip.rate != 0) {
    system.op.inertia[pulled].matrix() +=
        point_operator(Eigen::Matrix3d::Zero(), h * tip.rate * Eigen::Matrix3d::Identity(), offset);
  }
}

void add_active_torque(const ActiveTorque& torque, double h, StepSystem& system) {
  if (torque.value.size() > 0) {
    system.joint += h * torque.value;
    system.op.diagonal += h * torque.rate;
  }
}

StepSystem step_system(const Model& model, const State& state, const Kinematics& kin,
                       const TipForce& tip, double h) {
  StepSystem system;
  assemble_step_system(model, state, motion_of(kin), kin, tip, {h}, system);
  return system;
}

double kinetic_energy(const Model& model, const Kinematics& kin, int body, const Vector6d& twist,
                      const Eigen::Vector3d& velocity) {
  const Eigen::Vector3d rate = kin.rotation[body].transpose() * twist.head<3>();
  return 0.5 * (model.bodies[body].mass * velocity.squaredNorm() +
                rate.cwiseAbs2().dot(model.bodies[body].inertia));
}

double kinetic_energy(const Model& model, const Kinematics& kin, const Eigen::Vector3d& observer) {
  double energy = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    energy +=
        kinetic_energy(model, kin, b, kin.twist.col(b), kin.centre_velocity.col(b) - observer);
  }
  return energy;
}

double inner_kinetic_energy(const Model& model, const Kinematics& kin) {
  return kinetic_energy(model, kin, mean_by_mass(model, kin.centre_velocity));
}

// Velocities are carried along in the axes of the bodies, so that none has to be placed in the
// world.
void kinetic_energies(const Model& model, const State& state, Eigen::VectorXd& energies) {
  Eigen::Vector3d spin = state.qdot.segment<3>(3);
  Eigen::Vector3d velocity = root_orientation(state.q).conjugate() * state.qdot.head<3>();
  energies.resize(model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = b == 0 ? root_dofs : body.first_dof; k < body.first_dof + body.dofs; ++k) {
      const int axis = static_cast<int>(model.hinges[k - root_dofs].axis);
      const int second = (axis + 1) % 3;
      const int third = (axis + 2) % 3;
      const auto [sine, cosine] = sine_and_cosine(state.q[k + 1]);
      for (Eigen::Vector3d* v : {&spin, &velocity}) {
        const double before = (*v)[second];
        (*v)[second] = cosine * before + sine * (*v)[third];
        (*v)[third] = cosine * (*v)[third] - sine * before;
      }
      spin[axis] += state.qdot[k];
    }
    // Along the X axis to the centre, and on to the next body's origin.
    const Eigen::Vector3d half(0, 0.5 * body.length * spin.z(), -0.5 * body.length * spin.y());
    energies[b] =
        0.5 * (body.mass * (velocity + half).squaredNorm() + spin.cwiseAbs2().dot(body.inertia));
    velocity += 2 * half;
  }
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
