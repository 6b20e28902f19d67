#include "mujoco_ref/rollout.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/chain/kinematics.hpp"
#include "core/step/step.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {

Model smooth(Model model) {
  model.drag = {};
  model.cones.clear();
  for (Body& body : model.bodies) body.radius = 0;
  for (Hinge& hinge : model.hinges) {
    hinge.upper = INFINITY;
    hinge.lower = -hinge.upper;
  }
  return model;
}

namespace {

/// What a roll-out that cannot go on from `state` is told by: where, when and what helps.
std::string blow_up(const Model& model, const State& state, Head head, double time,
                    const std::string& why) {
  Eigen::Index fastest = 0;
  const double speed = state.qdot.cwiseAbs().maxCoeff(&fastest);
  return fmt::format(
      "{} at t = {:.4g} s with the head {}; {} was the fastest, at {:.3g} {}. Limits and drag are "
      "left out here; try less gravity or a smaller time.step",
      why, time, head == Head::clamped ? "clamped" : "free",
      dof_name(model, static_cast<int>(fastest)), speed, fastest < 3 ? "cm/s" : "rad/s");
}

}  // namespace

std::vector<State> core_rollout(const Model& animal, const State& start, Head head, TimeRule rule,
                                double h, int steps) {
  Scene scene;
  scene.time.rule = rule;
  scene.time.step = h;
  Model model = animal;
  model.obstacles.clear();
  Control control;
  control.clamp_head = head == Head::clamped;
  StepSolver solver("active-set");  // no row needs it
  StepSolution step;
  Observation observation;  // without contacts
  std::vector<State> states;
  State state = start;
  for (int i = 0; i < steps; ++i) {
    observation.kin = kinematics(model, state);
    const StepInput in{model, scene, state, observation, control};
    if (const Status status = solver.solve(in, step); !status.ok()) {
      throw StepError({status.outcome, blow_up(model, state, head, i * h, status.message)});
    }
    state.q = advance(state.q, step.qdot, h);
    state.qdot = step.next;
    states.push_back(state);
  }
  return states;
}

std::vector<State> mujoco_rollout(const Model& model, const State& start, MujocoModel& mirror,
                                  int steps) {
  set_state(model, start, mirror);
  std::vector<State> states;
  for (int i = 0; i < steps; ++i) {
    mj_step(mirror.model(), mirror.data());
    check_stable(mirror);
    states.push_back(state_of(model, mirror));
  }
  return states;
}

double velocity_difference(const State& a, const State& b) {
  const double size = b.qdot.lpNorm<Eigen::Infinity>();
  return (a.qdot - b.qdot).lpNorm<Eigen::Infinity>() / (size == 0 ? 1 : size);
}

double centre_distance(const Model& model, const State& a, const State& b) {
  return (kinematics(model, a).centre - kinematics(model, b).centre).colwise().norm().maxCoeff();
}

}  // namespace hagfish
