// The midpoint rule (core/README.md, "Steps in time"): the equations hold in the middle of a step,
// which passes of the rounds find.
#pragma once

#include "core/step/midpoint/midway.hpp"
#include "core/step/step_rule.hpp"
#include "solvers/fixed_point.hpp"

namespace hagfish {

/// A step takes StepMiddle::remaining of the last step to this power. So a measured value fades
/// towards 1, and is measured again every ten steps or so (after Hairer and Wanner, Solving
/// Ordinary Differential Equations II, IV.8).
inline double guessed_remaining(double before) { return std::pow(before, 0.9); }

class MidpointRule : public StepRule {
 public:
  Status begin(const StepInput& in, Rounds& rounds, WarmStart& warm, StepSolution& step) override;
  Status resume(const StepInput& in, Rounds& rounds, WarmStart& warm, StepSolution& step) override;
  void end(const StepInput& in, WarmStart& warm, StepSolution& step) override;
  StepPlace place(const StepInput& in) const override;

 private:
  void guess_middle(const StepInput& in, const WarmStart& warm);
  Status settle(const StepInput& in, Rounds& rounds, WarmStart& warm, StepSolution& step);
  Status find_middle(const StepInput& in, bool balanced, Rounds& rounds, WarmStart& warm,
                     StepSolution& step);
  Status solve_here(const StepInput& in, Rounds& rounds, const WarmStart& warm, StepSolution& step);

  Midway midway_;                ///< middle of the step last begun
  Eigen::VectorXd half_change_;  ///< half change of the last pass (set_next_velocity), nv
  // Step velocity and mean velocity, 2 nv.
  AndersonMixing passes_;
  Eigen::VectorXd first_guess_, placed_by_, led_to_, mixed_;
};

/// Computes step.next and the impacts of step.rows, for a step that is solved at `place` by
/// `problem`. Writes into `half_change` (nv) half of the change of velocity by steady forces. Not
/// ok (non_finite) where a prescribed limit cannot be released.
Status set_next_velocity(const StepInput& in, const StepPlace& place, const RowProblem& problem,
                         StepSolution& step, Eigen::VectorXd& half_change);

}  // namespace hagfish
