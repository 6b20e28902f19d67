// A log's frames and steps, as its run had them.
#pragma once

#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/judge/judge.hpp"

namespace hagfish {

/// The frames of a log. What a log lacks, as older ones do, is nan.
class LogFrames {
 public:
  /// The log, which has q, is referred to.
  explicit LogFrames(const LogContents& log);
  RunFrame at(Eigen::Index frame) const;

 private:
  const LogContents& log_;
  std::vector<double> head_end_, tail_end_;
  Hdf5Reader::Rows tip_, active_, thigmotaxis_, head_, obstacles_;
  std::vector<double> rows_;  ///< sum of the multipliers of Eq. 6 over h in each frame, dyn
  std::vector<EnergyLedger> energy_;
  std::vector<MomentumLedger> momentum_;
};

/// The knot type of each frame.
std::vector<KnotInvariants> logged_knots(const LogContents& log);

/// Shows a log to the judge: each frame, then the steps that begin between it and the next. Of a
/// log of frames, the worst figures of the steps since the frame before.
void replay(const LogContents& log, Judge& judge);

/// What its run comes to.
Judge judged_log(const LogContents& log);

}  // namespace hagfish
