// Time rules: the place where the equations of a step hold, and the velocity with which it ends.
#pragma once

#include "core/step/rounds.hpp"

namespace hagfish {

/// Calls the rounds of a step, and keeps its storage from step to step.
class StepRule {
 public:
  virtual ~StepRule() = default;

  /// Finds the place of the step and solves it there: step.qdot and step.next. Status as in
  /// Rounds::begin.
  virtual Status begin(const StepInput& in, Rounds& rounds, WarmStart& warm,
                       StepSolution& step) = 0;

  /// Solves the step again, after StepSolver::resume has added rows.
  virtual Status resume(const StepInput& in, Rounds& rounds, WarmStart& warm,
                        StepSolution& step) = 0;

  /// Ends a solved step: step.mean_velocity and step.lambda. Notes in `warm` what the next step
  /// starts with.
  virtual void end(const StepInput& in, WarmStart& warm, StepSolution& step) = 0;

  /// The place where the equations of the step hold. Call it after begin.
  virtual StepPlace place(const StepInput& in) const = 0;
};

/// The paper's rule: the equations hold at the start of a step, and the step moves by the velocity
/// that it ends with.
class EulerRule : public StepRule {
 public:
  Status begin(const StepInput& in, Rounds& rounds, WarmStart& warm, StepSolution& step) override {
    Status status = rounds.begin(in, place(in), warm, step);
    step.next = step.qdot;
    return status;
  }
  Status resume(const StepInput& in, Rounds& rounds, WarmStart& warm, StepSolution& step) override {
    Status status = rounds.resume(in, place(in), warm, step);
    step.next = step.qdot;
    return status;
  }
  void end(const StepInput& /*in*/, WarmStart& /*warm*/, StepSolution& step) override {
    step.lambda = step.multipliers;
    step.mean_velocity = step.qdot;
    step.mean_twist = step.twist;
    step.mean_centre_velocity = step.centre_velocity;
  }
  StepPlace place(const StepInput& in) const override { return start_of(in); }
};

}  // namespace hagfish
