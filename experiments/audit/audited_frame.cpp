#include "experiments/audit/audited_frame.hpp"

namespace hagfish {
namespace {

Midway midway_of(const LogContents& log, const State& state, const Kinematics& kin,
                 Eigen::Index frame) {
  Midway midway;
  if (log.midpoint() && frame < log.begun) {
    midway.step_velocity = log.middle_step_velocity.row(frame);
    midway.mean_velocity = log.middle_mean_velocity.row(frame);
    place_midway(log.model, state, kin, log.resolved.scene.time.step, log.balanced(frame),
                 keeps_momentum(log.resolved.scene, log.clamped(frame)), midway);
  }
  return midway;
}

}  // namespace

ShownFrame::ShownFrame(const LogContents& log, Eigen::Index frame)
    : index(frame),
      phase(static_cast<Phase>(log.phase[frame])),
      q(log.q.row(frame)),
      observation(
          observe(log.model, {q, Eigen::VectorXd::Zero(log.model.nv())}, log.resolved.scene)) {}

AuditedFrame::AuditedFrame(const LogContents& log, Eigen::Index frame)
    : index(frame),
      phase(static_cast<Phase>(log.phase[frame])),
      begins_step(frame < log.begun),
      clamped(log.clamped(frame)),
      state{log.q.row(frame), log.qdot.row(frame)},
      observation(observe(log.model, state, log.resolved.scene)),
      midway(midway_of(log, state, observation.kin, frame)),
      kin(log.midpoint() && begins_step ? midway.kin : observation.kin),
      segments(log.midpoint() && begins_step ? midway.segments : observation.segments),
      motion(log.midpoint() && begins_step ? midway.motion() : motion_of(kin)),
      qdot_next(log.qdot_next.row(frame)),
      qdot_step(log.midpoint() ? Eigen::VectorXd(log.qdot_step.row(frame)) : qdot_next),
      qdot_mean(log.midpoint() ? Eigen::VectorXd(0.5 * (state.qdot + qdot_next)) : qdot_next),
      step_twist(body_twists(log.model, kin, qdot_step)),
      mean_twist(body_twists(log.model, kin, qdot_mean)),
      step_centre_velocity(centre_velocities(kin, step_twist)),
      mean_centre_velocity(centre_velocities(kin, mean_twist)) {}

}  // namespace hagfish
