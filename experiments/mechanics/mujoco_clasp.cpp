#include "experiments/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/common/cpu_time.hpp"
#include "experiments/mechanics/clasp.hpp"
#include "mujoco_ref/mirror.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {
namespace {

void make_dense(Model& model, double density) {
  for (Body& body : model.bodies) {
    body.mass = density * body.length;
    body.inertia = cylinder_inertia(body.mass, body.length, body.radius);
  }
}

/// The loads, and drag per length as that of the chain across it: MuJoCo's own is of other forms.
void pull(const ClaspChain& both, MujocoModel& rope) {
  mjData& d = *rope.data();
  const int bodies = both.chain.model.body_count();
  std::fill(d.xfrc_applied, d.xfrc_applied + 6 * rope.model()->nbody, 0.0);
  const auto force = [&](int body) {
    return Eigen::Map<Eigen::Vector3d>(d.xfrc_applied + 6 * (body + 1));
  };
  for (const Load& load : both.loads) force(load.body) += load.force;
  force(bodies - 1).x() += clasp_pull;
  for (int b = 0; b < bodies; ++b) {
    mjtNum velocity[6];
    mj_objectVelocity(rope.model(), &d, mjOBJ_BODY, b + 1, velocity, 0);
    force(b) -= both.chain.model.drag.normal * both.chain.model.bodies[b].length *
                Eigen::Map<Eigen::Vector3d>(velocity + 3);
  }
}

Eigen::Matrix3Xd centres(const MujocoModel& rope, int bodies) {
  return Eigen::Map<const Eigen::Matrix3Xd>(rope.data()->xipos + 3, 3, bodies);
}

}  // namespace

MujocoClasp hook_in_mujoco(double link, const MujocoRope& input) {
  const double begin = cpu_time();
  ClaspChain both = clasp_chain(link);
  Model& model = both.chain.model;
  make_dense(model, input.density);
  // Less than ours: its time to bend is longer than that to come to rest here.
  for (Hinge& hinge : model.hinges) hinge.damping *= 0.1;
  MujocoModel rope(mjcf_files(model, clasp_apart, input.step, Head::clamped));
  mjModel& m = *rope.model();
  set_state(model, both.chain.state, rope);
  m.opt.tolerance = 1e-10;
  for (int g = 0; g < m.ngeom; ++g) {
    m.geom_solref[2 * g] = 2 * input.step;
    std::fill_n(m.geom_solimp + 5 * g, 2, 0.99);  // as hard from the first touch on
  }
  MujocoClasp clasp;
  clasp.bodies = model.body_count();
  constexpr double still = 1e-4;  // cm, of the tips; legs go on swinging, which does not move them
  constexpr double look = 2;      // s
  constexpr double longest = 40;  // s
  const auto between = static_cast<int>(std::lround(look / input.step));
  for (int k = 1; k * input.step < longest && !clasp.at_rest; ++k) {
    pull(both, rope);
    mj_step(&m, rope.data());
    if (k % between != 0) continue;
    const double now = both.tips(centres(rope, clasp.bodies));
    clasp.at_rest = std::abs(now - clasp.tips) < still;
    clasp.tips = now;
  }
  check_stable(rope);
  for (int c = 0; c < rope.data()->ncon; ++c)
    clasp.overlap = std::max(clasp.overlap, -rope.data()->contact[c].dist);
  clasp.cpu = cpu_time() - begin;
  return clasp;
}

}  // namespace hagfish
