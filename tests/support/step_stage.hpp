// A scene, its model and a state, ready to step, and what a step's answer is held against.
#pragma once

#include <vector>

#include "core/step/step.hpp"

namespace hagfish {

struct Stage {
  Stage();
  Scene scene;
  Model model;
  State state;
  Control control;
  StepSolver solver{"ipopt"};

  StepInput input(const Observation& now) const { return {model, scene, state, now, control}; }
  /// Throws StepError where the step cannot be solved.
  StepSolution solve();
  /// Every row that the step may use, by its makers.
  std::vector<Row> rows() const;
};

/// The hagfish in a knot whose three crossings touch, one of them 0.18 cm deep. It moves at random
/// and is pulled by the tail; thigmotaxis acts at the first and last contact.
Stage knotted(unsigned seed, double speed);

/// Three bodies in a line with two hinges about Z between ±`limit`; head clamped.
Stage two_hinges(double limit);

/// Every row that a step may use, by its makers.
std::vector<Row> every_row(const StepInput& in);

/// EXPECTs that `step` is the solution of the paper's Eq. 4 on all rows, rows left out included:
/// with its multipliers it meets the conditions that only the solution of a convex problem meets.
void expect_optimal(const StepInput& in, const StepSolution& step);
void expect_optimal(const Stage& s, const StepSolution& step);

/// The velocity by the paper's step, with every row in from the start.
Eigen::VectorXd paper_velocity(const Stage& s);

}  // namespace hagfish
