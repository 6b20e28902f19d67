// A rule of time: where the equations of a step hold, and what velocity it ends with.
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// Calls the rounds that a step takes, and keeps what it works in from step to step.
class StepRule {
 public:
  virtual ~StepRule() = default;

  /// Finds the step's place and solves the step there: step.qdot and step.next. Status as
  /// Rounds::begin.
  virtual Status begin(const StepInput& in, Rounds& rounds, WarmStart& warm,
                       StepSolution& step) = 0;

  /// The same again, after rows were added to step.rows and step.path_rows.
  virtual Status resume(const StepInput& in, Rounds& rounds, WarmStart& warm,
                        StepSolution& step) = 0;

  /// Ends a step that is solved: step.mean_velocity, and multipliers of its whole force. Notes in
  /// `warm` what the next step begins with.
  virtual void end(const StepInput& in, WarmStart& warm, StepSolution& step) = 0;

  /// Where the equations of the step hold, once it has begun.
  virtual StepPlace place(const StepInput& in) const = 0;
};

}  // namespace hagfish
