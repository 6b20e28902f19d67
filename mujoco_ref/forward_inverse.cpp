#include "mujoco_ref/forward_inverse.hpp"

#include "core/chain/dynamics.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {

Eigen::VectorXd driven_velocity(const Model& model, const State& state,
                                const Eigen::VectorXd& force, const Eigen::Vector3d& tip,
                                MujocoModel& mirror) {
  mjData& d = *mirror.data();
  set_state(model, state, mirror);
  mju_copy(d.qfrc_applied, force.data(), model.nv());
  // Row 0 is the world; a row is a force and a torque at the body's centre of mass.
  mju_copy3(d.xfrc_applied + 6 * static_cast<std::ptrdiff_t>(model.body_count()), tip.data());
  mj_step(mirror.model(), mirror.data());
  return state_of(model, mirror).qdot;
}

Eigen::VectorXd midway_force(const Model& model, const State& start, const Midway& midway,
                             double reach, MujocoModel& mirror) {
  mjData& d = *mirror.data();
  set_state(model, {midway.q, midway.step_velocity}, mirror);
  mj_forward(mirror.model(), &d);
  const Eigen::Index moving = mirror.model()->nv;
  const Eigen::VectorXd behind = (start.qdot - midway.step_velocity).tail(moving);
  Eigen::VectorXd momentum(moving);
  mj_mulM(mirror.model(), &d, momentum.data(), behind.data());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(model.nv());
  force.tail(moving) = momentum / reach;
  force += stiffness_force(model, start.q) - stiffness_force(model, midway.q);
  Kinematics kin = midway.kin;
  const Matrix6Xd bias = bias_wrench(model, kin, midway.motion());
  update_velocities(model, midway.step_velocity, kin);
  force += generalised_force(model, kin, bias_wrench(model, kin, motion_of(kin)) - bias);
  return force;
}

}  // namespace hagfish
