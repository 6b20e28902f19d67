// QPs taken out of a run, in both forms.
#include "experiments/benchmarks/step_qp.hpp"

#include <gtest/gtest.h>

#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::step_qp_test {

class StepQp : public testing::TestWithParam<StoredState> {};

TEST_P(StepQp, BothFormsHaveTheStepsOwnSolution) {
  // Long steps, with more rows in reach.
  SceneRun run = resumed(GetParam(), {"time.step=0.005"});
  const Model& model = run.model;
  for (int k = 0; k < 2; ++k) run.step();  // limits are prescribed once two steps have seen them
  const WarmStart warm = run.sim.solver.warm;
  const StepRecord& record = run.step();
  const StepSolution& step = record.solution;
  const std::vector<Row>& rows = step.rows;
  ASSERT_TRUE(has_qp(step));
  EXPECT_GE(step.prescribed, record.control.clamp_head ? 6 : 1);

  const BoxQp box = whole_dual(model, record.after.observation.kin, step.system, rows);
  ASSERT_EQ(box.b.size(), step.lambda.size());
  // To rounding of λ, of which a step finds those of prescribed rows in another way: seen 1e-12.
  EXPECT_LE(kkt_residuals(box, step.lambda).worst(), 1e-10);
  // The residual of the rows not prescribed is as large as that of the whole problem.
  EXPECT_LE(step.kkt.worst(),
            3 * kkt_residuals(box, step.lambda, step.excess, row_scale(box.A)).worst() + 1e-15);
  const PrimalQp primal = to_primal(model, run.scene, record);
  EXPECT_EQ(primal.e.size(), record.control.clamp_head ? 6 : 0);
  const BoxQp dual = dual_of(primal);
  // Bilateral rows come first, so that the order is the same. A condition of H of 1.4e6 and as much
  // in the units of A's entries: 3e-10 of rounding; seen 1.1e-10 where the compiler has no FMA.
  EXPECT_LE(relative_error(dual.A, box.A), 3e-10);
  EXPECT_LE(relative_error(dual.b, box.b), 3e-10);
  EXPECT_EQ(dual.lower, box.lower);
  const Eigen::MatrixXd C = dense_rows(model, record.after.observation.kin, rows);
  EXPECT_LE(relative_error(primal.C, C.bottomRows(primal.d.size())), 1e-13);

  const Eigen::VectorXd start = kept_multipliers(rows, warm);
  EXPECT_FALSE(start.isZero(0)) << "a warm one";
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const WarmStart::Kept* kept = warm.find(rows[i].id);
    EXPECT_EQ(start[i], kept == nullptr ? 0 : kept->lambda);
  }

  EXPECT_FALSE(at_cap(step));
  StepSolution capped = step;
  bool soft = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::isfinite(rows[i].upper)) {
      capped.lambda[static_cast<Eigen::Index>(i)] = rows[i].upper;
      soft = true;
    }
  }
  EXPECT_EQ(at_cap(capped), soft);
}

/// Early in the script no unilateral row is in reach, and the step has no QP.
std::vector<StoredState> states_with_qp() {
  std::vector<StoredState> states = stored_states();
  std::erase_if(states, [](const StoredState& stored) { return stored.name == "form early"; });
  return states;
}

INSTANTIATE_TEST_SUITE_P(Table1, StepQp, testing::ValuesIn(states_with_qp()), name_of);

}  // namespace hagfish::step_qp_test
