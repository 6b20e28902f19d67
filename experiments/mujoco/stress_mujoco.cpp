#include "experiments/mujoco/stress_mujoco.hpp"

#include <fmt/format.h>

#include "core/control/script.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

// MuJoCo makes a time constant of less than two steps two. 4 and 10 steps, and shares of 0.9 and of
// 0.9999, its most, were tried: fewer stress scenes hold.
constexpr double hard_constant = 2;  // steps
constexpr double hard_share = 0.99;

/// The drag and the force `tip` (dyn, world) on the last body as a generalised force (nv).
Eigen::VectorXd applied_force(const Model& model, const State& state, const Kinematics& kin,
                              const Eigen::Vector3d& tip) {
  Eigen::VectorXd force;
  Matrix6Xd wrench = Matrix6Xd::Zero(6, model.body_count());
  const int last = model.body_count() - 1;
  wrench.col(last) = wrench_of_force(tip, kin.centre_offset(last));
  generalised_force(model, kin, wrench, force);
  return force + drag_force(model, kin, state.qdot);
}

void guard(const Observation& observation, const GuardSettings& limits) {
  if (!observation.kin.centre.allFinite()) {
    throw StepError({Outcome::non_finite, "positions or velocities are not finite numbers"});
  }
  if (observation.penetration > limits.penetration) {
    throw StepError({Outcome::penetration, "deeper than guard.penetration"});
  }
  if (observation.limit_violation > limits.limit_violation) {
    throw StepError({Outcome::limits, "further than guard.limit_violation"});
  }
  const double speed = observation.kin.centre_velocity.colwise().norm().maxCoeff();
  if (!(speed <= limits.speed)) {
    throw StepError({Outcome::speed, fmt::format("{:.3g} cm/s, over guard.speed", speed)});
  }
}

}  // namespace

std::string not_in_mujoco(const Scene& scene) {
  if (scene.start.phase != Phase::form || scene.expect.slide_distance > 0) {
    return "thigmotaxis is not in MuJoCo";
  }
  if (scene.time.rule != TimeRule::euler) {
    return "time.rule = midpoint is not a rule of MuJoCo's";
  }
  if (scene.model.bending_limit == BendingLimit::cone) {
    return "limits on the total angle of a joint are not in MuJoCo";
  }
  if (scene.flesh.present()) return "flesh is not in MuJoCo";
  if (!scene.obstacles.empty()) return "obstacles do not hold bodies in MuJoCo as they do here";
  return scene.wall.present ? "the head plate is not in the mirrored model" : "";
}

double mechanical_energy(const Model& model, const State& state, const Kinematics& kin) {
  return kinetic_energy(model, kin) + elastic_energy(model, state.q) + gravity_energy(model, kin);
}

bool run_in_mujoco(const Model& model, const Scene& scene, const State& start, int integrator,
                   bool hard, const std::function<bool()>& out_of_time, StressJudge& judge) {
  const double h = scene.time.step;
  const Head head = scene.clamp_head ? Head::clamped : Head::free;
  MujocoModel mirror(mjcf_files(model, scene.contact.least_arc, h, head));
  mirror.model()->opt.integrator = integrator;
  if (hard) set_stiffness(hard_constant * h, hard_share, *mirror.model());
  set_state(model, start, mirror);
  State state = state_of(model, mirror);
  ContactSearch search;
  Observation observation, next;
  observe(model, state, scene, search, observation);
  const int last = model.body_count() - 1;
  double work = 0;
  for (int i = 0; i * h + 0.5 * h < scene.time.duration; ++i) {
    if (out_of_time()) {
      return false;
    }
    const Kinematics& kin = observation.kin;
    const Eigen::Vector3d velocity = kin.centre_velocity.col(last);
    const TipForce tip =
        script_force(scene.script, i * h, scene.time, kin.centre.col(last), velocity);
    const Eigen::Vector3d pull = tip.value - tip.rate * velocity;
    const Eigen::VectorXd force = applied_force(model, state, kin, pull);
    const int nv = mirror.model()->nv;
    mju_copy(mirror.data()->qfrc_applied, force.data() + (model.nv() - nv), nv);
    mj_step(mirror.model(), mirror.data());
    check_stable(mirror);
    const State before = state;
    state = state_of(model, mirror);
    observe(model, state, scene, search, next);
    // Over the way that the point went, whatever the integrator.
    work += pull.dot(next.kin.centre.col(last) - kin.centre.col(last));
    judge.see(before, state, next, (i + 1) * h, {mechanical_energy(model, state, next.kin), work});
    guard(next, scene.guard);
    std::swap(observation, next);
  }
  return true;
}

}  // namespace hagfish
