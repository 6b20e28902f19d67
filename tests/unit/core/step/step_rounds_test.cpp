// Rows that come and go while a step is solved: warm starts, rows left out at first, prescribed
// limits. None of it changes the answer.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_chain.hpp"
#include "tests/support/step_stage.hpp"

namespace hagfish::step_rounds_test {

TEST(Step, WarmStartKeepsTheRowsWithAForce) {
  Stage s = knotted(99, 1);
  const StepSolution cold = s.solve();
  ASSERT_GT(cold.active, 0);
  EXPECT_EQ(s.solver.warm.size(), static_cast<std::size_t>(cold.active));
  for (std::size_t i = 0; i < cold.rows.size(); ++i) {
    const WarmStart::Kept* kept = s.solver.warm.find(cold.rows[i].id);
    if (kept != nullptr) {
      EXPECT_EQ(kept->lambda, cold.lambda[static_cast<Eigen::Index>(i)]);
    }
  }
  // The answer does not depend on the guess: solver tolerance.
  const StepSolution warm = s.solve();
  EXPECT_LT(relative_error(warm.qdot, cold.qdot), 1e-7);
  const RowId gone{.of = RowId::Of::plane, .first = 12345};
  s.solver.warm.add(gone, 1e9);
  s.solver.warm.end();
  EXPECT_LT(relative_error(s.solve().qdot, cold.qdot), 1e-7);
  EXPECT_EQ(s.solver.warm.find(gone), nullptr);
}

TEST(Step, RowsLeftOutComeInWhereTheAnswerViolatesThem) {
  // The first hinge runs into its limit; the shock flings the second one, which was slow and clear
  // of its own, past it within the step.
  Stage s = two_hinges(0.5);
  s.model.hinges[0].upper = 0;
  s.scene.time.step = 0.05;
  s.state.qdot[6] = 8;
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, paper_velocity(s)), 1e-7);  // solver tolerance
  EXPECT_NEAR(step.qdot[7], 10, 1e-5);                            // to its limit in one step
}

TEST(Step, LeavingRowsOutChangesNothing) {
  for (const unsigned seed : {101U, 102U}) {
    Stage s = knotted(seed, 20);
    s.scene.time.step = 0.02;
    const StepSolution step = s.solve();
    EXPECT_LT(step.rows.size(), s.rows().size());
    // The multipliers may be shared otherwise, the velocity is unique: to the condition of H times
    // rounding, and to what a row left out may fall short, 1e-8 rad/s of 20.
    EXPECT_LT(relative_error(step.qdot, paper_velocity(s)), 1e-8) << seed;
    expect_optimal(s, step);
  }
}

/// A warm start in which these limits have pushed as hard for two steps.
WarmStart steady(const std::vector<Row>& rows) {
  WarmStart warm;
  for (int k = 0; k < 2; ++k) {
    warm.begin();
    for (const Row& row : rows) {
      if (row.kind == RowKind::limit) warm.add(row.id, 1);
    }
    warm.end();
  }
  return warm;
}

TEST(Step, PrescribesLimitsThatPushSteadily) {
  Stage s = knotted(106, 1);
  int limits = 0;
  for (int k = 0; k < 20; ++k) {
    SCOPED_TRACE(k);
    const StepSolution step = s.solve();
    expect_optimal(s, step);
    EXPECT_LT(relative_error(step.qdot, paper_velocity(s)), 1e-7);  // solver tolerance
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      EXPECT_EQ(step.rows[i].prescribed, static_cast<Eigen::Index>(i) < step.prescribed);
      if (step.rows[i].prescribed) {
        EXPECT_EQ(step.excess[static_cast<Eigen::Index>(i)], 0) << "met exactly";
        limits += step.rows[i].kind == RowKind::limit ? 1 : 0;
      }
    }
    s.state.qdot = step.qdot;
    s.state.q = advance(s.state.q, step.qdot, s.scene.time.step);
  }
  EXPECT_GT(limits, 20);
}

TEST(Step, ReleasesPrescribedLimitsThatWouldHaveToPull) {
  Stage s = knotted(107, 20);
  s.scene.time.step = 0.02;  // limits are in reach
  const StepSolution cold = s.solve();
  const auto resting =
      std::ranges::count_if(cold.rows, [](const Row& row) { return row.kind == RowKind::limit; });
  ASSERT_GT(resting, 3);
  s.solver.warm = steady(cold.rows);
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  EXPECT_LT(step.prescribed, 6 + resting);
  EXPECT_GT(step.prescribed, 6);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, cold.qdot), 1e-7);  // solver tolerance
}

TEST(Step, ReleasesPrescribedLimitsThatContradictOtherRows) {
  // With both hinges prescribed the plate could not push the last body out.
  Stage s = two_hinges(3);
  s.model.hinges[0].upper = 2.5;
  s.model.hinges[1].upper = 0.5;
  s.state.q[7] = 2.5;
  s.state.q[8] = 0.5;
  s.scene.wall.neck = 2;
  s.model.obstacles = obstacles_of(s.scene);
  const StepSolution cold = s.solve();
  ASSERT_GT(cold.force[RowKind::obstacle].norm(), 0);
  s.solver.warm = steady(s.rows());
  const StepSolution step = s.solve();
  EXPECT_GT(step.rounds, 1);
  EXPECT_EQ(step.prescribed, 0);
  expect_optimal(s, step);
  EXPECT_LT(relative_error(step.qdot, cold.qdot), 1e-7);  // solver tolerance
}

}  // namespace hagfish::step_rounds_test
