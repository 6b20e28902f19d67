// QPs taken out of a run, in both forms.
#include "experiments/step_qp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

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
  for (int k = 0; k < 2; ++k) {  // limits are held once two steps have seen them
    take_step(model, resolved.scene, solver, sim);
  }
  const WarmStart warm = sim.warm;
  const StepRecord record = take_step(model, resolved.scene, solver, sim);
  ASSERT_EQ(record.solution.kind, SolveKind::qp);
  const Eigen::Index held = record.solution.held;
  const Eigen::Index others = record.solution.lambda.size() - held;
  EXPECT_EQ(solver.problem().b.size(), others) << "the last problem";
  EXPECT_FALSE(solver.start().isZero(0)) << "a warm one";
  StoredQp qp;
  to_primal(model, record, warm, qp);
  ASSERT_TRUE(qp.primal);
  const BoxQp dual = dual_of(*qp.primal);
  // Held rows are the first of a step, bilateral ones the first of them, so that the order is the
  // same. What is left of the dual problem once A x = b is solved for them is the step's own. A
  // condition of H of 1.4e6 and as much in the units of A's entries.
  const BoxQp& own = solver.problem();
  ASSERT_EQ(dual.b.size(), held + others);
  EXPECT_EQ(qp.primal->e.size(), record.control.clamp_head ? 6 : 0);
  Eigen::MatrixXd A = dual.A.bottomRightCorner(others, others);
  Eigen::VectorXd b = dual.b.tail(others);
  if (held > 0) {
    const Eigen::LLT<Eigen::MatrixXd> factor(dual.A.topLeftCorner(held, held));
    A -= dual.A.bottomLeftCorner(others, held) * factor.solve(dual.A.topRightCorner(held, others));
    b -= dual.A.bottomLeftCorner(others, held) * factor.solve(dual.b.head(held));
  }
  EXPECT_LE(relative_error(A, own.A), 1e-10);
  EXPECT_LE(relative_error(b, own.b), 1e-10);
  EXPECT_EQ(dual.lower.tail(others), own.lower);
  if (record.solution.rounds == 1) {  // else it started from the round before
    EXPECT_EQ(qp.start.tail(others), solver.start());
  }
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

/// Early in the script no unilateral row is in reach, and the step has no QP.
std::vector<StoredState> states_with_qp() {
  std::vector<StoredState> states = stored_states();
  std::erase_if(states, [](const StoredState& stored) { return stored.name == "form early"; });
  return states;
}

INSTANTIATE_TEST_SUITE_P(Table1, StepQp, testing::ValuesIn(states_with_qp()), name_of);

}  // namespace
}  // namespace hagfish
