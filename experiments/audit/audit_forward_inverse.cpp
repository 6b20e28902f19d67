#include "experiments/audit/audit_forward_inverse.hpp"

#ifdef HAGFISH_MUJOCO
#include <cmath>

#include "core/chain/dynamics.hpp"
#include "mujoco_ref/forward_inverse.hpp"
#include "mujoco_ref/log_model.hpp"
#include "mujoco_ref/mirror.hpp"
#endif

namespace hagfish {

#ifdef HAGFISH_MUJOCO

namespace {

/// All forces of each frame but the tip's, generalised.
Hdf5Reader::Rows generalised_forces(const LogContents& log) {
  Hdf5Reader::Rows sum = log.h5.rows("/forces/thigmotaxis");
  for (const char* block : {"contact", "limit", "head", "wall", "active"}) {
    sum += log.h5.rows(std::string("/forces/") + block);
  }
  return sum;
}

}  // namespace

Finding audit_forward_inverse(const LogContents& log) {
  const Model& model = log.model;
  MujocoModel mirror = mujoco_model_of(log.h5);
  const std::string difference =
      first_difference(*mirror.model(), model, log.resolved.scene.time.step);
  if (!difference.empty()) {
    throw FileError(log.h5.file() + ": /mjcf is not the scene's model: " + difference);
  }
  use_core_rule(mirror);
  const Hdf5Reader::Rows sum = generalised_forces(log);
  const Hdf5Reader::Rows tip = log.h5.rows("/forces/tip");
  double largest_error = 0;
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const State state{log.q.row(f), log.qdot.row(f)};
    const Eigen::VectorXd next = log.qdot_next.row(f);
    const Kinematics kin = kinematics(model, state);
    const Eigen::VectorXd force = sum.row(f).transpose() + drag_force(model, kin, next);
    const Eigen::VectorXd driven = driven_velocity(model, state, force, tip.row(f), mirror);
    const double off =
        (driven - next).allFinite() ? (driven - next).lpNorm<Eigen::Infinity>() : INFINITY;
    largest_error = worse(largest_error, off > 0 ? off / next.lpNorm<Eigen::Infinity>() : off);
  }
  return judged_over(
      {"forward-inverse", largest_error, log.resolved.scene.expect.forward_inverse, "of q̇"},
      "MuJoCo's step under the logged forces at every frame");
}

#else

Finding audit_forward_inverse(const LogContents& /*log*/) {
  return {"forward-inverse", true, "not judged: this program is built without MuJoCo", "", "", ""};
}

#endif

}  // namespace hagfish
