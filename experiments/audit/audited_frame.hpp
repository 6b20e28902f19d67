// One frame of a log as the audit sees it: what was logged of its state, and what follows from
// that.
#pragma once

#include <algorithm>
#include <utility>

#include "core/log/reading/log_contents.hpp"
#include "core/run/simulation.hpp"
#include "core/step/midpoint/midway.hpp"

namespace hagfish {

/// One frame without its velocities, which logs below LogLevel::full do not have.
struct ShownFrame {
  ShownFrame(const LogContents& log, Eigen::Index frame);

  Eigen::Index index;
  Phase phase;
  Eigen::VectorXd q;
  Observation observation;  ///< observation at rest there
};

struct AuditedFrame {
  AuditedFrame(const LogContents& log, Eigen::Index frame);
  AuditedFrame(const AuditedFrame&) = delete;
  AuditedFrame& operator=(const AuditedFrame&) = delete;

  Eigen::Index index;
  Phase phase;
  bool begins_step;  ///< it is not the state at the run's end
  bool clamped;      ///< the head is
  State state;
  Observation observation;  ///< observed again from the logged state

  // The step that begins at the frame; nan where none does.
  Midway midway;                               ///< middle by the midpoint rule
  const Kinematics& kin;                       ///< pose at the place where its equations hold
  const std::vector<SplineSegment>& segments;  ///< segments there
  StepMotion motion;                           ///< motion there
  Eigen::VectorXd qdot_next;                   ///< velocity after it
  Eigen::VectorXd qdot_step;                   ///< velocity by which it moves
  Eigen::VectorXd qdot_mean;                   ///< velocity of springs, damping and drag
  Matrix6Xd step_twist, mean_twist;            ///< bodies' twists at these, 6 x N
  Eigen::Matrix3Xd step_centre_velocity, mean_centre_velocity;  ///< centre velocities, 3 x N, cm/s
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

/// A run's steps by the frames of its log: frame f begins with step f stride of the log, but for
/// the state at the end, which comes after the last one.
struct Steps {
  explicit Steps(const LogContents& log);
  std::int64_t stride = 1, count = 0;
  /// Index along /steps of the step that begins at a frame; of the state at the end, their number.
  Eigen::Index at(Eigen::Index frame) const { return std::min(frame * stride, count); }
};

}  // namespace hagfish
