// Live progress of a run on the terminal: phase, simulated time, speed, time left, knot.
#pragma once

#include <chrono>

#include "core/run/simulation.hpp"

namespace hagfish {

class Progress {
 public:
  /// Silent where `quiet`. On a terminal one line is redrawn; elsewhere a line now and then.
  Progress(const Model& model, const Scene& scene, bool quiet);
  ~Progress() { end(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Each change of phase or knot type gets a line of its own.
  void show(const StepRecord& record);
  /// Tells what the step warns of, also where quiet.
  void warn(const StepRecord& record);
  /// Ends the line that is being redrawn.
  void end();
  /// Wall time that the run took so far, s.
  double elapsed() const;

 private:
  double estimated_end(const StepRecord& record) const;
  void show_change(const StepRecord& record);

  const Model& model_;
  const Scene& scene_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point begin_;
  double next_ = 0;  // elapsed() at the next line, s
  Phase phase_ = Phase::form;
  KnotInvariants type_;
};

}  // namespace hagfish
