#include "tests/support/chain_runs.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace hagfish {

Scene bare_scene(double h) {
  Scene scene;
  scene.time.step = h;
  scene.contact.least_arc = std::numeric_limits<double>::infinity();
  return scene;
}

void append_root(Model& model, double length) {
  Body root;
  root.mass = 1;
  root.length = length;
  root.inertia.setOnes();
  append_body(model, root, {});
}

Body thin_rod(double mass, double length) {
  Body body;
  body.mass = mass;
  body.length = length;
  body.inertia = cylinder_inertia(mass, length, 0);
  return body;
}

ChainRun::ChainRun(Model chain, Scene of)
    : model(std::move(chain)),
      scene(std::move(of)),
      state(rest_state(model)),
      solver_("active-set") {}

void ChainRun::step(const TipForce& tip) {
  Control control;
  control.clamp_head = scene.clamp_head;
  control.tip = tip;
  step(control);
}

void ChainRun::step(const Control& control) {
  seen = observe(model, state, scene);
  if (const Status status = solver_.solve({model, scene, state, seen, control}, last);
      !status.ok()) {
    throw StepError(status);
  }
  state.q = advance(state.q, last.qdot, scene.time.step);
  state.qdot = last.next;
  time += scene.time.step;
}

double ChainRun::energy() const {
  const Kinematics kin = kinematics(model, state);
  return kinetic_energy(model, kin) + gravity_energy(model, kin) + elastic_energy(model, state.q);
}

Eigen::Matrix3Xd ChainRun::centres() const { return kinematics(model, state).centre; }

ChainRun chain_round_a_post() {
  Model model;
  append_root(model, post_link);
  for (int b = 1; b < 86; ++b) {
    append_body(model, thin_rod(0.02, post_link), {Axis::z});
    model.hinges.back().damping = 0.1;  // dyn cm s
  }
  model.drag = {.normal = 1, .tangential = 1};
  const Eigen::Vector3d post(12, post_radius, 0), half(0, 0, 5);
  model.obstacles.push_back({"post", Strand{{post - half, post + half}, post_radius}});
  ChainRun run(model, bare_scene(0.002));
  // The joints that turn by the angle that a link takes on the post.
  const double turn = 2 * std::asin(post_link / 2 / post_radius);
  const int first = static_cast<int>(post.x() / post_link);
  const int count = static_cast<int>(std::round(std::numbers::pi / turn));
  run.state.q.segment(7 + first - 1, count).setConstant(std::numbers::pi / count);
  return run;
}

double measured_period(ChainRun& run, const std::function<double(const State&)>& coordinate,
                       int periods) {
  constexpr int patience = 1'000'000;
  double first = 0;
  int crossings = 0;
  double before = coordinate(run.state);
  for (int i = 0; i < patience; ++i) {
    run.step();
    const double now = coordinate(run.state);
    if (before > 0 && now <= 0) {
      const double time = run.time - run.scene.time.step * now / (now - before);
      if (crossings == 0) {
        first = time;
      } else if (crossings == periods) {
        return (time - first) / periods;
      }
      ++crossings;
    }
    before = now;
  }
  throw std::runtime_error("the coordinate does not swing about 0");
}

}  // namespace hagfish
