// The step against the same Eq. 4 on dense matrices, with all rows that could matter. Its velocity
// and multipliers meet the conditions of Eq. 4, which has one solution.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/step_stage.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::equation4_test {

/// Three steps on, each against the paper's. Returns how many cones pushed.
int compare(SceneRun run) {
  run.scene.constraints.corrections = 0;         // which add rows that the paper has not
  run.scene.time.momentum = FreeMomentum::rule;  // the paper's
  int pushing = 0;
  for (int k = 0; k < 3; ++k) {
    SCOPED_TRACE(run.sim.step);
    const StepRecord& record = run.step();
    const State &before = record.after.state, &now = run.sim.now.state;
    expect_optimal({run.model, run.scene, before, record.after.observation, record.control},
                   record.solution);
    // Eqs. 1 and 2: the new velocity, and where it leads.
    EXPECT_EQ(now.qdot, record.solution.qdot);
    EXPECT_EQ(now.q, advance(before.q, record.solution.qdot, run.scene.time.step));
    for (const BendingCone& cone : run.model.cones) {
      pushing += record.solution.force[RowKind::limit].segment<2>(cone.dof).isZero(0) ? 0 : 1;
    }
  }
  return pushing;
}

class Equation4 : public testing::TestWithParam<std::tuple<StoredState, std::string>> {};

TEST_P(Equation4, IsMetByTheStep) {
  const auto& [stored, back_end] = GetParam();
  SceneRun run(stored_scene());
  for (const Eq6Point at : {Eq6Point::centreline, Eq6Point::skin}) {
    run.scene.controller.eq6_at = at;
    run.sim = resume(run.model, run.scene, stored, back_end);
    compare(run);
  }
}

TEST(Equation4OfCones, IsMetByTheStep) {
  SceneRun run(stored_scene({"model.bending_limit=cone"}));
  int pushing = 0;
  for (const double time : {8.0, 10.5, 12.0, 13.0, 15.0, 16.0}) {  // s; from tying to sliding
    while (run.time() < time) run.step();
    for (const std::string& back_end : box_qp_solver_names()) {
      SceneRun other = run;
      other.sim.solver = StepSolver(back_end);
      other.sim.solver.warm = run.sim.solver.warm;
      pushing += compare(std::move(other));
    }
  }
  EXPECT_GT(pushing, 20);
}

std::string name_of_pair(const testing::TestParamInfo<Equation4::ParamType>& pair) {
  const auto& [stored, back_end] = pair.param;
  std::string name = name_of({stored, pair.index}) + "_" + back_end;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table1, Equation4,
                         testing::Combine(testing::ValuesIn(stored_states()),
                                          testing::ValuesIn(box_qp_solver_names())),
                         name_of_pair);

}  // namespace hagfish::equation4_test
