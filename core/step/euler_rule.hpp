// The paper's time rule: the equations hold at the start of a step, and the step moves by the
// velocity that it ends with.
#pragma once

#include "core/step/step_rule.hpp"

namespace hagfish {

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
