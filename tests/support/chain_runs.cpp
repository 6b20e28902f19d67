#include "tests/support/chain_runs.hpp"

#include <limits>
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
  seen = observe(model, state, scene);
  if (const Status status = solver_.solve({model, scene, state, seen, control}, last);
      !status.ok()) {
    throw StepError(status);
  }
  state.qdot = last.qdot;
  state.q = advance(state.q, state.qdot, scene.time.step);
  time += scene.time.step;
}

double ChainRun::energy() const {
  const Kinematics kin = kinematics(model, state);
  return kinetic_energy(model, kin) + gravity_energy(model, kin) + elastic_energy(model, state.q);
}

Eigen::Matrix3Xd ChainRun::centres() const { return kinematics(model, state).centre; }

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
