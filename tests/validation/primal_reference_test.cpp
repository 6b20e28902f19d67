// The step against the paper's as printed: dense H, dense rows, all of them that could matter from
// the start, another formulation of Ipopt. Both must find the same state.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/step/paper_step.hpp"
#include "tests/support/primal_reference.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::primal_reference_test {

/// Rows this far from binding, cm/s or rad/s, stay out of the reference: Ipopt's accuracy goes with
/// the largest right-hand side, and that of a far plane is 20,000 cm/s. The step sees them all.
constexpr double far = 5;

/// The rows of a step from their makers, and not from the step's own list.
std::vector<Row> all_rows_of(const StepInput& in, const Eigen::VectorXd& base) {
  const auto& [model, scene, state, now, control] = in;
  const double h = scene.time.step;
  std::vector<Row> rows =
      thigmotaxis_rows(model, control.thigmotaxis, scene.controller, now.kin, h);
  for (const std::vector<Row>& more : {contact_rows(model, now.contact, scene.constraints, h),
                                       limit_rows(model, state, scene.constraints, h),
                                       plane_rows(model, now.kin, scene.constraints, h)}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const Matrix6Xd twist = body_twists(model, now.kin, base);
  const Eigen::Matrix3Xd centre_velocity = centre_velocities(now.kin, twist);
  std::erase_if(rows, [&](const Row& row) {
    return row_velocity(row, {twist, centre_velocity}, base) - row.rhs > far;
  });
  if (control.clamp_head) append_head_rows(state, scene.constraints, h, rows);
  return rows;
}

/// Three steps on from `sim`, each against the paper's. Returns how many cones pushed.
int compare(const Model& model, const Scene& scene, Simulation sim) {
  int pushing = 0;
  for (int k = 0; k < 3; ++k) {
    SCOPED_TRACE(sim.step);
    const StepRecord record = take_step(model, scene, sim);
    const Moment& now = record.moment;
    const Eigen::VectorXd& qdot = record.solution.qdot;
    const StepInput in{model, scene, now.state, now.observation, record.control};
    const State reference =
        paper_step(in, all_rows_of(in, sim.solver.problem().base), [&](const PrimalQp& qp) {
          const PrimalQpSolution solution = solve_primal(qp);
          EXPECT_EQ(solution.status, SolveStatus::solved);
          // Of the two, the step's own must be the better: it meets every row and costs no more,
          // both to rounding of rows of 1e4 cm/s and costs of 1e3 erg.
          EXPECT_LE((qp.d - qp.C * qdot).maxCoeff(), 1e-9);
          const auto cost = [&qp](const Eigen::VectorXd& v) {
            return 0.5 * v.dot(qp.H * v) - qp.g.dot(v);
          };
          EXPECT_LE(cost(qdot), cost(solution.v) + 1e-10 * std::abs(cost(solution.v)));
          return solution.v;
        });
    // The reference stops at products of 1e-14 of multiplier and excess. Where both are small, an
    // interior point is off by their root, times up to 1e3 in the lightest joints (the root of the
    // condition of H, 1.4e6): 1e-4. Seen: 2e-5.
    EXPECT_LE((qdot - reference.qdot).lpNorm<Eigen::Infinity>(),
              1e-4 * qdot.lpNorm<Eigen::Infinity>());
    // Eq. 2 with those velocities.
    EXPECT_LE((sim.now.state.q - reference.q).lpNorm<Eigen::Infinity>(),
              scene.time.step * 1e-4 * qdot.lpNorm<Eigen::Infinity>());
    for (const BendingCone& cone : model.cones) {
      pushing += record.solution.force[RowKind::limit].segment<2>(cone.dof).isZero(0) ? 0 : 1;
    }
  }
  return pushing;
}

class PrimalReference : public testing::TestWithParam<std::tuple<StoredState, std::string>> {};

TEST_P(PrimalReference, FindsTheSameVelocity) {
  const auto& [stored, back_end] = GetParam();
  const ResolvedScene resolved = stored_scene();
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Scene scene = resolved.scene;
  scene.time.momentum = FreeMomentum::rule;  // the paper's
  for (const Eq6Point at : {Eq6Point::centreline, Eq6Point::skin}) {
    scene.controller.eq6_at = at;
    compare(model, scene, resume(model, scene, stored, back_end));
  }
}

TEST(PrimalReferenceOfCones, FindsTheSameVelocity) {
  const ResolvedScene resolved = stored_scene({"model.bending_limit=cone"});
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  // Rows that a step takes in for what its path shows are not the reference's.
  Scene linear = resolved.scene;
  linear.constraints.corrections = 0;
  linear.time.momentum = FreeMomentum::rule;
  Simulation sim = start(model, resolved.scene, "active-set");
  StepRecord record;
  int pushing = 0;
  for (const double time : {8.0, 10.5, 12.0, 13.0, 15.0, 16.0}) {  // s; from tying to sliding
    while (time_of(sim, resolved.scene) < time) {
      take_step(model, resolved.scene, sim, record);
    }
    for (const std::string& back_end : box_qp_solver_names()) {
      Simulation other = sim;
      other.solver = StepSolver(back_end);
      other.solver.warm = sim.solver.warm;
      pushing += compare(model, linear, std::move(other));
    }
  }
  EXPECT_GT(pushing, 20);
}

std::string name_of_pair(const testing::TestParamInfo<PrimalReference::ParamType>& pair) {
  const auto& [stored, back_end] = pair.param;
  std::string name = name_of({stored, pair.index}) + "_" + back_end;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table1, PrimalReference,
                         testing::Combine(testing::ValuesIn(stored_states()),
                                          testing::ValuesIn(box_qp_solver_names())),
                         name_of_pair);

}  // namespace hagfish::primal_reference_test
