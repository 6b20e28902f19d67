#include "core/log/means/log_means.hpp"

namespace hagfish {
namespace {

/// Nan where there is nothing to divide by.
double ratio(double a, double b) {
  return b > 0 ? a / b : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

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
