#include "core/log/means/log_means.hpp"

#include <limits>

namespace hagfish {
namespace {

/// Calls `visit` with each part of the means that is a vector.
template <class Means, class Visit>
void visit_vectors(Means& means, Visit visit) {
  for (auto& force : means.force.of_kind) visit(force);
  visit(means.active_torque);
  visit(means.net_force);
}

}  // namespace

RunningMeans::RunningMeans(Eigen::Index nv) {
  visit_vectors(sum_, [nv](Eigen::VectorXd& v) { v.resize(nv); });
  clear();
}

void RunningMeans::clear() {
  visit_vectors(sum_, [](Eigen::VectorXd& v) { v.setZero(); });
  sum_.lambda = {};
  sum_.speed = {};
  sum_.slack = {};
  sum_.sum_of_rows = 0;
  sum_.pulls = false;
  with_row_ = {};
  steps_ = 0;
}

void RunningMeans::take(const StepRecord& record, const ThigmotaxisRows& rows) {
  const StepSolution& step = record.solution;
  sum_.pulls = steps_ == 0 ? record.controller.phase == Phase::pull : sum_.pulls;
  ++steps_;
  for (const RowKind kind : row_kinds) sum_.force[kind] += step.force[kind];
  sum_.active_torque += step.active_torque;
  sum_.net_force += step.net_force;
  sum_.sum_of_rows += rows.sum;
  for (int k = 0; k < 4; ++k) {
    if (rows.present[k]) {
      ++with_row_[k];
      sum_.lambda[k] += rows.lambda[k];
      sum_.speed[k] += rows.speed[k];
      sum_.slack[k] += rows.slack[k];
    }
  }
}

const FrameMeans& RunningMeans::close() {
  const double per_step = steps_ > 0 ? 1.0 / steps_ : std::numeric_limits<double>::quiet_NaN();
  mean_ = sum_;
  visit_vectors(mean_, [per_step](Eigen::VectorXd& v) { v *= per_step; });
  mean_.sum_of_rows *= per_step;
  for (int k = 0; k < 4; ++k) {
    mean_.lambda[k] *= per_step;
    mean_.speed[k] /= with_row_[k];  // 0 / 0 where there was no row
    mean_.slack[k] /= with_row_[k];
  }
  clear();
  return mean_;
}

}  // namespace hagfish
