// Inertia, bias and passive forces: the matrix and right-hand side of the paper's Eq. 1.
//
// RedMax form (Wang et al. 2019): M = J' M_m J and f = J' (f_m - M_m J̇ q̇), with M_m the bodies'
// inertias. Damping, drag and stiffness are taken linearly implicitly, as RedMax does:
// H = M + h D - h² K in place of M.
#pragma once

#include <vector>

#include "core/chain/articulated.hpp"
#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/chain/state.hpp"

namespace hagfish {

/// M_m: each body's inertia about O, world axes (g cm^2, g cm, g).
Matrix6d body_inertia(const Model& model, const Kinematics& kin, int body);
std::vector<PaddedOperator> body_inertias(const Model& model, const Kinematics& kin);

/// Water drag of one body: normal and tangential drag per length (model.drag) integrated along it,
/// as an operator on the twist, about O. The drag is minus this times the twist.
Matrix6d drag_operator(const Model& model, const Kinematics& kin, int body);

/// Drag as a generalised force (nv) at velocities `v` (nv).
Eigen::VectorXd drag_force(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v);

/// M_m J̇ q̇ plus the gyroscopic wrench: the inertial wrench of each body at q̈ = 0 (6 x N), where the
/// bodies have the twists motion.mean_twist and move as `kin` says; with as much of each body's
/// momentum as brings its power to motion.bias_power.
Matrix6Xd bias_wrench(const Model& model, const Kinematics& kin, const StepMotion& motion);

/// Gravity on each body (6 x N).
Matrix6Xd gravity_wrench(const Model& model, const Kinematics& kin);

/// Stiffness torque -k q at the angles of q (nv; zero at the root).
Eigen::VectorXd stiffness_force(const Model& model, const Eigen::VectorXd& q);

/// A force on the centre of the last body, or of another one: `value` minus `rate` times the
/// centre's velocity at the end of the step, by the midpoint rule its mean over the step. A
/// scripted force has rate 0; an implicit spring-damper has rate h kp + kd.
struct TipForce {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< dyn, world
  double rate = 0;                                  ///< dyn s / cm
  int body = -1;                                    ///< body that it is on; -1: the last one

  int on(const Model& model) const { return body >= 0 ? body : model.body_count() - 1; }
};

/// Torques that the animal's muscles make at its hinges: `value` minus `rate` times the hinges'
/// rates at the end of the step, or their mean as above. Both are empty where there are none; else
/// of length nv, and 0 at the root: nothing holds on to the world.
struct ActiveTorque {
  Eigen::VectorXd value;  ///< dyn cm
  Eigen::VectorXd rate;   ///< dyn cm s, not negative
  int saturated = -1;     ///< the first velocity whose torque is all that muscles have; -1: none
};

/// One step's unconstrained problem H q̇* = M q̇0 + h f (paper, Eq. 1).
struct StepSystem {
  StepOperator op;        ///< H = M + h D - h² K
  Matrix6Xd bias;         ///< bias_wrench, but with moments about the bodies' centres, 6 x N
  Matrix6Xd wrench;       ///< right-hand side, body part, 6 x N, dyn cm s and dyn s
  Eigen::VectorXd joint;  ///< right-hand side, joint part, nv, dyn cm s or dyn s
};

/// Timing of a step's forces (TimeSettings).
struct ForceTiming {
  double reach = 0;           ///< how far into the step they act, s
  double spring_damping = 0;  ///< numerical damping of springs, over their stiffness, s
};

/// Numerical damping of the hinges' springs (core/README.md, "Steps in time"), nv: `damping` (s)
/// times their stiffness, against the velocity after a step from `before` on which the mean
/// velocity is `mean_velocity` (nv both).
Eigen::VectorXd ring_damping_force(const Model& model, double damping,
                                   const Eigen::VectorXd& before,
                                   const Eigen::VectorXd& mean_velocity);

/// Assembles Eq. 1 at the place of the step, `kin`, whose bodies move as the step does and as
/// `motion` says. The step starts from `state`.
void assemble_step_system(const Model& model, const State& state, const StepMotion& motion,
                          const Kinematics& kin, const TipForce& tip, const ForceTiming& when,
                          StepSystem& system);
/// Assembles Eq. 1 of a step that starts where and as `kin` says.
StepSystem step_system(const Model& model, const State& state, const Kinematics& kin,
                       const TipForce& tip, double h);

/// Adds active torques to the problem of a step of `h` (s): their rates to H's diagonal.
void add_active_torque(const ActiveTorque& torque, double h, StepSystem& system);

/// Kinetic energy of one body, erg, at `twist`, which moves its centre with `velocity`.
double kinetic_energy(const Model& model, const Kinematics& kin, int body, const Vector6d& twist,
                      const Eigen::Vector3d& velocity);

/// Kinetic energy of all bodies at kin.twist, erg, for an observer who moves with this velocity
/// (cm/s, world).
double kinetic_energy(const Model& model, const Kinematics& kin,
                      const Eigen::Vector3d& observer = Eigen::Vector3d::Zero());
/// Kinetic energy about the centre of mass, erg: the same for each observer.
double inner_kinetic_energy(const Model& model, const Kinematics& kin);

/// Kinetic energy of each body, erg (N), straight from a state: its kinematics need not be known.
void kinetic_energies(const Model& model, const State& state, Eigen::VectorXd& energies);

// What follows is asked of every body in each step, where calls would put vectors into memory.

/// A symmetric operator about a body's centre: plain 1 + along aa' + side ss', with a and s the
/// body's X and Y axes. Inertia and drag have this form, in which a step assembles and applies
/// them. body_inertia and drag_operator are the same as matrices, for the step on dense ones.
struct AxisOperator {
  double plain = 0, along = 0, side = 0;

  Eigen::Vector3d times(const Eigen::Matrix3d& axes, const Eigen::Vector3d& v) const {
    return plain * v + along * axes.col(0).dot(v) * axes.col(0) +
           side * axes.col(1).dot(v) * axes.col(1);
  }
};

inline AxisOperator inertia_about_centre(const Body& body) {
  const Eigen::Vector3d& i = body.inertia;
  return {i.z(), i.x() - i.z(), i.y() - i.z()};
}

/// How one body moves: its angular velocity, rad/s, and the velocity of its centre, cm/s, world.
struct PointMotion {
  Eigen::Vector3d spin, velocity;
};
inline PointMotion body_motion(const BodyVelocities& bodies, int body) {
  return {bodies.twist.col(body).head<3>(), bodies.centre.col(body)};
}

/// A moment about a body's centre, dyn cm, and a force on it, dyn; world. Vectors of three stay in
/// registers, where those of six would go through memory.
struct CentreWrench {
  Eigen::Vector3d moment, force;
};

/// Drag on one body that moves as `motion`.
inline CentreWrench drag_on_body(const Model& model, const Kinematics& kin, int body,
                                 const PointMotion& motion) {
  // drag_at_centre without its matrices: each step asks this of every body.
  const double length = model.bodies[body].length;
  const Eigen::Vector3d along = kin.rotation[body].col(0);
  const Eigen::Vector3d forward = motion.velocity.dot(along) * along;
  const Eigen::Vector3d turn = motion.spin - motion.spin.dot(along) * along;
  return {-model.drag.normal * length * length * length / 12 * turn,
          -length *
              (model.drag.normal * (motion.velocity - forward) + model.drag.tangential * forward)};
}

/// Power over one motion of a body against the drag that it has at another one, erg/s: symmetric.
inline double drag_power(const Model& model, const Kinematics& kin, int body,
                         const PointMotion& over, const PointMotion& at) {
  const double length = model.bodies[body].length;
  const Eigen::Vector3d along = kin.rotation[body].col(0);
  const double forward = over.velocity.dot(along) * at.velocity.dot(along);
  const double sideways = over.velocity.dot(at.velocity) - forward;
  const double turning = over.spin.dot(at.spin) - over.spin.dot(along) * at.spin.dot(along);
  return length * (model.drag.normal * (sideways + turning * length * length / 12) +
                   model.drag.tangential * forward);
}

/// How much momentum one body has: angular about its centre, g cm²/s, and linear, g cm/s.
struct BodyMomentum {
  Eigen::Vector3d angular, linear;

  /// Power over a motion, erg: twice the kinetic energy over the same motion.
  double times(const PointMotion& motion) const {
    return angular.dot(motion.spin) + linear.dot(motion.velocity);
  }
};
inline BodyMomentum body_momentum(const Model& model, const Kinematics& kin, int body,
                                  const PointMotion& motion) {
  const Body& of = model.bodies[body];
  return {inertia_about_centre(of).times(kin.rotation[body], motion.spin),
          of.mass * motion.velocity};
}

/// Energy in the joint springs, erg.
double elastic_energy(const Model& model, const Eigen::VectorXd& q);

/// Potential energy in gravity, erg; zero at the world's origin.
double gravity_energy(const Model& model, const Kinematics& kin);

}  // namespace hagfish
