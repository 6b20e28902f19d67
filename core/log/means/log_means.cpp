#include "core/log/means/log_means.hpp"

#include <cmath>

namespace hagfish {
namespace {

/// Calls `visit` with each part of the means that is a vector.
template <class Means, class Visit>
void visit_vectors(Means& means, Visit visit) {
  for (auto& force : means.force.of_kind) visit(force);
  visit(means.active_torque);
  visit(means.net_force);
}

/// Nan where there is nothing to divide by.
double ratio(double a, double b) { return b > 0 ? a / b : NAN; }

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
  const double per_step = steps_ > 0 ? 1.0 / steps_ : NAN;
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

PullFigures pull_figures(const FrameMeans& mean) {
  const Eigen::VectorXd& wall = mean.force[RowKind::obstacle];
  const Eigen::Index hinges = wall.size() - root_dofs;
  PullFigures pull;
  pull.force = pull_of(mean.force[RowKind::head]);
  pull.plate = wall[0];
  // The moment about the origin of a force F along x at (0, y, z) is (0, z F, -y F).
  pull.bearing = {ratio(-wall[5], pull.plate), ratio(wall[4], pull.plate)};
  pull.torque = (mean.active_torque + mean.force[RowKind::thigmotaxis])
                    .tail(hinges)
                    .lpNorm<Eigen::Infinity>();
  pull.advantage_rows = ratio(pull.force, mean.sum_of_rows);
  pull.advantage_torque = ratio(pull.force, pull.torque);
  return pull;
}

}  // namespace hagfish
