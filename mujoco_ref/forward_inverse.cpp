#include "mujoco_ref/forward_inverse.hpp"

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

}  // namespace hagfish
