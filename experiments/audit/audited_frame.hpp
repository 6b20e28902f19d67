// One frame of a log as the audit sees it: what was logged of its state, and what follows from
// that.
#pragma once

#include <algorithm>
#include <utility>

#include "core/run/simulation.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

struct AuditedFrame {
  AuditedFrame(const LogContents& log, Eigen::Index frame)
      : index(frame),
        phase(static_cast<Phase>(log.phase[frame])),
        state{log.q.row(frame), log.qdot.row(frame)},
        qdot_next(log.qdot_next.row(frame)),
        observation(observe(log.model, state, log.resolved.scene)),
        next_velocity(centre_velocities(observation.kin,
                                        body_twists(log.model, observation.kin, qdot_next))) {}

  Eigen::Index index;
  Phase phase;
  State state;
  Eigen::VectorXd qdot_next;
  Observation observation;         ///< observed again from the logged state
  Eigen::Matrix3Xd next_velocity;  ///< of the bodies' centres at qdot_next, 3 x N, cm/s
};

/// Whether a logged spline parameter lies on the animal.
inline bool on_spline(const Model& model, double parameter) {
  return parameter >= 0 && parameter <= model.body_count() - 1;
}
/// Its segment and t.
inline std::pair<int, double> spline_point(const Model& model, double parameter) {
  const int segment = std::min(static_cast<int>(parameter), model.body_count() - 2);
  return {segment, parameter - segment};
}

/// A run's steps by the frames of its log: frame f begins with step first + f stride.
struct Steps {
  explicit Steps(const LogContents& log);
  std::int64_t first = 0, stride = 1;
  /// Index along /steps of the step that begins at a frame.
  Eigen::Index at(Eigen::Index frame) const { return frame * stride; }
};

}  // namespace hagfish
