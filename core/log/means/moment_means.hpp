// Moments at the joints, as means over the steps from one frame of the log to the next.
#pragma once

#include "core/chain/joint_moments.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Moments about the joints, in axes_of_joints, 3 x N, dyn cm.
struct JointMoments {
  ByKind<Eigen::Matrix3Xd> of_rows;  ///< moments of the forces of each kind of row
  Eigen::Matrix3Xd active;           ///< moments of the muscles' torques
};

/// All 0.
JointMoments no_moments(const Model& model);

/// Adds what the forces of a step do about the joints at the place of its equations: where it
/// starts, by the midpoint rule in its middle.
void add_moments(const Model& model, const TimeSettings& time, const StepRecord& record,
                 JointMoments& sum);

/// Adds up the moments of the steps from frame to frame.
class MomentMeans {
 public:
  explicit MomentMeans(const Model& model) : sum_(no_moments(model)) {}
  void take(const Model& model, const TimeSettings& time, const StepRecord& record) {
    add_moments(model, time, record, sum_);
    ++steps_;
  }
  /// Means of all steps since the last call, nan where there are none; then starts over.
  const JointMoments& close();

 private:
  JointMoments sum_, mean_;
  int steps_ = 0;
};

}  // namespace hagfish
