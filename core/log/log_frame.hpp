// What the tables of a log hold, before any file is there: of frames, of steps, and of the rows of
// the step at a frame, which are contacts with a force and rows of Eq. 6.
#pragma once

#include "core/log/log_level.hpp"
#include "core/log/log_table.hpp"
#include "core/log/means/log_means.hpp"
#include "core/log/means/moment_means.hpp"
#include "core/log/means/thigmotaxis_rows.hpp"
#include "core/muscle/activation.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Worst figures of the steps since the last frame.
struct Worst {
  double penetration = 0;      ///< cm
  double limit_violation = 0;  ///< rad
  double head_drift = 0;       ///< cm
  double kkt = 0;
  void take(const StepRecord& record);
};

struct Frame {
  const StepRecord& record;
  const ThigmotaxisRows& thigmotaxis;
  const FrameMeans& mean;
  const JointMoments& moments;  ///< means over the same steps
  KnotVote knot;
  double skin_fold = 0;  ///< skin_fold()
  Worst worst;
  double wall_time = 0;  ///< s
  /// Effort of the muscles for the means since the frame before; nan at the first frame.
  const MuscleEffort& muscles;
};

/// Every dataset along the frames (log schema, rows along T). The requests of a law other than the
/// paper's do not all follow from the scene: /control holds them where the law is the run's own.
LogTable<Frame> frame_table(const Model& model, const Scene& scene, LogLevel level);

/// What is logged of every step.
struct LoggedStep {
  const StepRecord& record;
  const ThigmotaxisRows& thigmotaxis;
};

/// The datasets along the steps, /steps: few figures, but of every step.
LogTable<LoggedStep> step_table(const Scene& scene, LogLevel level);

/// A contact with a force, of the step at a frame.
struct BearingContact {
  std::int32_t frame = 0;  ///< index along the frames
  const Row& row;          ///< a row of kind contact or obstacle
  double force = 0;        ///< λ / h, dyn
};

/// A row of Eq. 6 of the step at a frame.
struct FrameRow {
  std::int32_t frame = 0;  ///< index along the frames
  ThigmotaxisRow row;
};

/// /eq6, a row for each row of Eq. 6 at a frame, at whatever contact (Law::logs_rows); of other
/// laws /thigmotaxis has them all.
LogTable<FrameRow> row_table(LogLevel level);

/// /contacts, a row for each contact with a force at a frame. Which obstacle it is with is said
/// where the scene has others than the head plate.
LogTable<BearingContact> contact_table(const Scene& scene, LogLevel level);

}  // namespace hagfish
