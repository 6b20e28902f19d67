// QPs taken out of a run, in both forms.
#include "experiments/step_qp.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish {
namespace {

class StepQp : public testing::TestWithParam<StoredState> {};

TEST_P(StepQp, PrimalFormHasTheStepsOwnDual) {
  // Long steps, with more rows in reach.
  const ResolvedScene resolved = stored_scene({"time.step=0.005"});
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  RememberingSolver solver(make_box_qp_solver("active-set"));
  Simulation sim = resume(model, resolved.scene, GetParam());
  take_step(model, resolved.scene, solver, sim);
  const StepRecord record = take_step(model, resolved.scene, solver, sim);
  if (record.solution.kind != SolveKind::qp) {
    GTEST_SKIP() << "no unilateral row is in reach";
  }
  EXPECT_EQ(solver.problem().b.size(), record.solution.lambda.size()) << "the last problem";
  EXPECT_FALSE(solver.start().isZero(0)) << "a warm one";
  StoredQp qp;
  qp.start = solver.start();
  to_primal(model, record, qp);
  ASSERT_TRUE(qp.primal);
  const BoxQp dual = dual_of(*qp.primal);
  // Bilateral rows are the first of a step already, so that the order is the same. A condition of H
  // of 1.4e6 and as much in the units of A's entries.
  const BoxQp& own = solver.problem();
  ASSERT_EQ(dual.b.size(), own.b.size());
  EXPECT_EQ(qp.primal->e.size(), record.control.clamp_head ? 6 : 0);
  EXPECT_LE(relative_error(dual.A, own.A), 1e-10);
  EXPECT_LE(relative_error(dual.b, own.b), 1e-10);
  EXPECT_EQ(dual.lower, own.lower);
  EXPECT_EQ(qp.start, solver.start());
  const std::vector<Row>& rows = record.solution.rows;
  const Eigen::MatrixXd C = dense_rows(model, record.situation.kin, rows);
  EXPECT_LE(relative_error(qp.primal->C, C.bottomRows(qp.primal->d.size())), 1e-13);

  EXPECT_FALSE(at_cap(record.solution));
  StepSolution capped = record.solution;
  bool soft = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::isfinite(rows[i].upper)) {
      capped.lambda[static_cast<Eigen::Index>(i)] = rows[i].upper;
      soft = true;
    }
  }
  EXPECT_EQ(at_cap(capped), soft);
}

INSTANTIATE_TEST_SUITE_P(Table1, StepQp, testing::ValuesIn(stored_states()), name_of);

}  // namespace
}  // namespace hagfish
