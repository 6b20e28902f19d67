#include "mujoco_ref/rollout.hpp"

#include <limits>

#include "core/chain/kinematics.hpp"
#include "core/step/step.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {

Model smooth(Model model) {
  model.drag = {};
  model.cones.clear();
  for (Body& body : model.bodies) body.radius = 0;
  for (Hinge& hinge : model.hinges) {
    hinge.upper = std::numeric_limits<double>::infinity();
    hinge.lower = -hinge.upper;
  }
  return model;
}

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
      throw StepError(status);
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
