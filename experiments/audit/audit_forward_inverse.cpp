#include "experiments/audit/audit_parts.hpp"

#ifdef HAGFISH_MUJOCO
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "mujoco_ref/forward_inverse.hpp"
#include "mujoco_ref/mirror.hpp"
#include "mujoco_ref/mjcf.hpp"
#endif

namespace hagfish {

#ifdef HAGFISH_MUJOCO

namespace {

/// All forces of each frame but the tip's, generalised, kind by kind.
std::vector<Hdf5Reader::Rows> generalised_forces(const LogContents& log) {
  std::vector<Hdf5Reader::Rows> kinds = {log.h5.rows("/forces/active")};
  for (const RowKindEntry& kind : row_kind_table) {
    kinds.push_back(log.h5.rows(std::string("/forces/") + kind.name));
  }
  return kinds;
}

MujocoModel mirror_of(const LogContents& log) {
  const TimeSettings& time = log.resolved.scene.time;
  MujocoModel mirror(mjcf_files(log.model, log.resolved.scene.contact.least_arc, time.step));
  mirror.model()->opt.timestep = time.reach();
  use_core_rule(mirror);
  return mirror;
}

}  // namespace

/// At so many frames at most, evenly apart: MuJoCo takes 2 ms for each, more than all other audits.
/// Every frame's forces are held against Eq. 1 by ForceAudit.
constexpr Eigen::Index most_frames = 100;

/// Of q̇ that MuJoCo makes of the forces, of its largest entry: both round, over 200 bodies.
constexpr double forward_inverse_tolerance = 1e-8;

struct ForwardInverseAudit::Driven {
  const LogContents& log;
  MujocoModel mirror;
  std::vector<Hdf5Reader::Rows> kinds;
  Hdf5Reader::Rows tip;
  double largest_error = 0;
  std::int64_t seen = 0;  ///< frames

  /// Largest entry of the velocities that one kind of force alone gives the animal at rest at `q`,
  /// each beside gravity. A kind that does not act leaves gravity's.
  double largest_alone(Eigen::Index frame, const Eigen::VectorXd& q) {
    const State rest{q, Eigen::VectorXd::Zero(log.model.nv())};
    double largest = 0;
    const bool falls = !log.model.gravity.isZero(0);
    const auto see = [&](const Eigen::VectorXd& force, const Eigen::Vector3d& at_tip) {
      if (force.isZero(0) && at_tip.isZero(0) && !falls) return;
      const Eigen::VectorXd alone = driven_velocity(log.model, rest, force, at_tip, mirror);
      largest = std::max(largest, alone.lpNorm<Eigen::Infinity>());
    };
    for (const Hdf5Reader::Rows& kind : kinds) see(kind.row(frame), Eigen::Vector3d::Zero());
    see(Eigen::VectorXd::Zero(log.model.nv()), tip.row(frame));
    return largest;
  }
};

ForwardInverseAudit::ForwardInverseAudit(const LogContents& log)
    : driven_(std::make_unique<Driven>(
          Driven{log, mirror_of(log), generalised_forces(log), log.h5.rows("/forces/tip")})) {}

void ForwardInverseAudit::see(const AuditedFrame& frame) {
  auto& [log, mirror, kinds, tip, largest_error, seen] = *driven_;
  const Eigen::Index f = frame.index;
  if (f % (1 + log.q.rows() / most_frames) != 0) return;
  ++seen;
  State from = frame.state;
  Eigen::VectorXd force = drag_force(log.model, frame.kin, frame.qdot_mean);
  for (const Hdf5Reader::Rows& kind : kinds) force += kind.row(f);
  if (log.midpoint()) {
    from = {frame.midway.q, frame.midway.step_velocity};
    const TimeSettings& time = log.resolved.scene.time;
    force +=
        midway_force(log.model, frame.state, frame.midway, time.reach(), mirror) +
        ring_damping_force(log.model, time.spring_damping(), frame.state.qdot, frame.qdot_mean);
  }
  const Eigen::VectorXd driven = driven_velocity(log.model, from, force, tip.row(f), mirror);
  const Eigen::VectorXd& wanted = frame.qdot_mean;
  const double off =
      (driven - wanted).allFinite() ? (driven - wanted).lpNorm<Eigen::Infinity>() : INFINITY;
  if (off == 0) return;
  // An animal that pulls at what does not give comes to rest while its forces go on: what is known
  // of the velocity is then what rounding leaves of theirs. Where the error is a smaller share of
  // q̇ than one found before, the larger scale need not be known.
  double scale = wanted.lpNorm<Eigen::Infinity>();
  if (!(off <= largest_error * scale)) scale = std::max(scale, driven_->largest_alone(f, from.q));
  largest_error = worse(largest_error, off / scale);
}

Finding ForwardInverseAudit::finding() const {
  return judged_over(
      {"forward-inverse", driven_->largest_error, forward_inverse_tolerance, "of scale"},
      fmt::format("q̇ after MuJoCo's step under the logged forces, of q̇ or what one kind of them "
                  "alone makes of it, at {} frames",
                  driven_->seen));
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
