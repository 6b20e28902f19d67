#include "core/log/means/moment_means.hpp"

#include <cmath>

namespace hagfish {
namespace {

template <class Visit>
void visit_all(JointMoments& moments, Visit visit) {
  for (Eigen::Matrix3Xd& moment : moments.of_rows.of_kind) visit(moment);
  visit(moments.active);
}

}  // namespace

JointMoments no_moments(const Model& model) {
  JointMoments none;
  visit_all(none, [&](Eigen::Matrix3Xd& m) { m.setZero(3, model.body_count()); });
  return none;
}

void add_moments(const Model& model, const TimeSettings& time, const StepRecord& record,
                 JointMoments& sum) {
  const StepSolution& step = record.solution;
  if ((step.lambda.array() == 0).all() && step.active_torque.isZero(0)) return;
  Kinematics middle;
  if (time.rule == TimeRule::midpoint) {
    const Eigen::VectorXd& q = record.after.state.q;
    update_positions(model, advance(q, step.middle.step_velocity, time.step / 2), middle);
  }
  const Kinematics& kin = time.rule == TimeRule::midpoint ? middle : record.after.observation.kin;
  const std::vector<Eigen::Matrix3d> axes = axes_of_joints(kin);
  Matrix6Xd wrench;
  Eigen::VectorXd joint;  // rows on bodies leave it as it is
  for (const RowKind kind : row_kinds) {
    bool on_bodies = false;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      const Row& row = step.rows[i];
      const double lambda = step.lambda[static_cast<Eigen::Index>(i)];
      if (row.kind != kind || row.joint() != nullptr || lambda == 0) continue;
      if (!on_bodies) wrench.setZero(6, model.body_count());
      on_bodies = true;
      add_row(row, kin, lambda / time.step, wrench, joint);
    }
    if (on_bodies) add_moments(kin, wrench, axes, sum.of_rows[kind]);
  }
  add_hinge_moments(model, kin, step.force[RowKind::limit], axes, sum.of_rows[RowKind::limit]);
  add_hinge_moments(model, kin, step.active_torque, axes, sum.active);
}

const JointMoments& MomentMeans::close() {
  const double per_step = steps_ > 0 ? 1.0 / steps_ : NAN;
  mean_ = sum_;
  visit_all(mean_, [per_step](Eigen::Matrix3Xd& m) { m *= per_step; });
  visit_all(sum_, [](Eigen::Matrix3Xd& m) { m.setZero(); });
  steps_ = 0;
  return mean_;
}

}  // namespace hagfish
