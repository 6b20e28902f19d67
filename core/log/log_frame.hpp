// What a frame of the log holds, before any file is there.
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

}  // namespace hagfish
