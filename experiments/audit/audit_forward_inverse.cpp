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
  Hdf5Reader::Rows sum = Hdf5Reader::Rows::Zero(log.q.rows(), log.model.nv());
  for (const RowKindEntry& kind : row_kind_table) {
    sum += log.h5.rows(std::string("/forces/") + kind.name);
  }
  return sum + log.h5.rows("/forces/active");
}

MujocoModel mirror_of(const LogContents& log) {
  const TimeSettings& time = log.resolved.scene.time;
  MujocoModel mirror = mujoco_model_of(log.h5);
  const std::string difference = first_difference(*mirror.model(), log.model, time.step);
  if (!difference.empty()) {
    throw FileError(log.h5.file() + ": /mjcf is not the scene's model: " + difference);
  }
  mirror.model()->opt.timestep = time.reach();
  use_core_rule(mirror);
  return mirror;
}

}  // namespace

struct ForwardInverseAudit::Driven {
  const LogContents& log;
  MujocoModel mirror;
  Hdf5Reader::Rows sum, tip;
  double largest_error = 0;
};

ForwardInverseAudit::ForwardInverseAudit(const LogContents& log)
    : driven_(std::make_unique<Driven>(
          Driven{log, mirror_of(log), generalised_forces(log), log.h5.rows("/forces/tip")})) {}

void ForwardInverseAudit::see(const AuditedFrame& frame) {
  auto& [log, mirror, sum, tip, largest_error] = *driven_;
  const Eigen::Index f = frame.index;
  State from = frame.state;
  Eigen::VectorXd force =
      sum.row(f).transpose() + drag_force(log.model, frame.kin, frame.qdot_felt);
  if (log.midpoint()) {
    from = {frame.midway.q, frame.midway.moved};
    const TimeSettings& time = log.resolved.scene.time;
    force +=
        midway_force(log.model, frame.state, frame.midway, time.reach(), mirror) +
        ring_damping_force(log.model, time.spring_damping(), frame.state.qdot, frame.qdot_felt);
  }
  const Eigen::VectorXd driven = driven_velocity(log.model, from, force, tip.row(f), mirror);
  const Eigen::VectorXd& wanted = frame.qdot_felt;
  const double off =
      (driven - wanted).allFinite() ? (driven - wanted).lpNorm<Eigen::Infinity>() : INFINITY;
  largest_error = worse(largest_error, off > 0 ? off / wanted.lpNorm<Eigen::Infinity>() : off);
}

Finding ForwardInverseAudit::finding() const {
  return judged_over({"forward-inverse", driven_->largest_error,
                      driven_->log.resolved.scene.expect.forward_inverse, "of q̇"},
                     "MuJoCo's step under the logged forces at every frame");
}

#else

struct ForwardInverseAudit::Driven {};

ForwardInverseAudit::ForwardInverseAudit(const LogContents& /*log*/) {}

void ForwardInverseAudit::see(const AuditedFrame& /*frame*/) {}

Finding ForwardInverseAudit::finding() const {
  return {"forward-inverse", true, "not judged: this program is built without MuJoCo", "", "", ""};
}

#endif

ForwardInverseAudit::~ForwardInverseAudit() = default;

}  // namespace hagfish
