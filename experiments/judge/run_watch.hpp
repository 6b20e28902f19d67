// Has a run judged step by step, without a log.
#pragma once

#include "experiments/judge/judge.hpp"

namespace hagfish {

class RunWatch {
 public:
  /// All are referred to.
  RunWatch(const Model& model, const Scene& scene, Judge& judge);
  /// Each step, in order, from step 0.
  void see(const StepRecord& record);
  /// The run has ended as `sim`: no step follows.
  void see_end(const Simulation& sim);

 private:
  void see_frame(const StepRecord& record, bool at_end);

  const Model& model_;
  const Scene& scene_;
  Judge& judge_;
  RunningMeans means_;
  bool any_ = false, clamped_ = false;
};

}  // namespace hagfish
