#include "core/step/look_ahead.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/random_chain.hpp"
#include "tests/support/stored_states.hpp"

namespace hagfish::look_ahead_test {

/// Deepest overlap at `count` places evenly along the way of a step to `end`, which is the last.
double deepest_on_way(const Model& model, const Scene& scene, const StepRecord& record,
                      const State& end, int count) {
  // How long it went on, from the hinges: a step may end early.
  const Eigen::Index hinges = model.nv() - root_dofs;
  const Eigen::VectorXd rate = record.solution.qdot.tail(hinges);
  const double time = rate.dot((end.q - record.after.state.q).tail(hinges)) / rate.squaredNorm();
  double deepest = 0;
  for (int i = 1; i <= count; ++i) {
    const double t = time * i / count;
    const State there{advance(record.after.state.q, record.solution.qdot, t), record.solution.qdot};
    deepest = std::max(deepest, observe(model, there, scene).penetration);
  }
  return deepest;
}

TEST(LookAhead, ShortStepsAreLookedAtTheirEndAlone) {
  Eigen::Matrix3Xd velocity = Eigen::Matrix3Xd::Zero(3, 4);
  EXPECT_EQ(path_samples(velocity, Eigen::Vector3d::Zero(), 0.01, 0.25), 1);
  velocity.col(2) << 0, 24, 0;
  EXPECT_EQ(path_samples(velocity, Eigen::Vector3d::Zero(), 0.01, 0.25), 1);
  velocity.col(2) << 0, -60, 80;  // 1 cm
  EXPECT_EQ(path_samples(velocity, Eigen::Vector3d::Zero(), 0.01, 0.3), 4);
}

/// Steps of the stored knot that slides, ten times as long as the scene's.
struct LongSteps : SceneRun {
  explicit LongSteps(const std::vector<std::string>& overrides)
      : SceneRun(resumed(stored_state("slide"), overrides)) {}
  /// Deepest overlap at the end of any of so many steps.
  double deepest(int steps) {
    double worst = 0;
    for (int k = 0; k < steps; ++k) {
      corrected += step().solution.rounds > 1 ? 1 : 0;
      worst = std::max(worst, sim.now.observation.penetration);
    }
    return worst;
  }
  int corrected = 0;
};

TEST(LookAhead, HoldsStrandsApartAlongTheCurvedPath) {
  LongSteps corrected({"time.step=0.02"});
  LongSteps linear({"time.step=0.02", "constraints.corrections=0"});
  const double tolerance = corrected.scene.constraints.tolerance;
  // The rows alone let five times the tolerance through; corrections leave what they may, and half
  // of what was there before.
  EXPECT_GT(linear.deepest(50), 5 * tolerance);
  EXPECT_LT(corrected.deepest(50), 2.001 * tolerance);
  EXPECT_GT(corrected.corrected, 5);
}

TEST(LookAhead, AddsRowsOnceAndMeetsThem) {
  LongSteps run({"time.step=0.02"});
  for (int k = 0; k < 50; ++k) {
    run.deepest(1);
    std::set<RowId> ids;
    for (const Row& row : run.record.solution.rows) {
      EXPECT_TRUE(ids.insert(row.id).second) << row_name(run.model, row);
    }
    // The bound of the KKT residual of any step.
    EXPECT_LT(run.record.solution.kkt.worst(), run.scene.expect.kkt);
  }
}

TEST(LookAhead, LeavesViolatedRowsAsRedMaxHasThem) {
  LongSteps run({"time.step=0.02", "constraints.activation=violated"});
  LongSteps none(
      {"time.step=0.02", "constraints.activation=violated", "constraints.corrections=0"});
  EXPECT_EQ(run.deepest(20), none.deepest(20));
}

/// A hairpin whose arms close at `speed` (cm/s) at their ends, 15 degrees apart.
SceneRun closing_arms(double speed) {
  Scene scene = table1_scene(50);
  scene.clamp_head = false;
  scene.wall.present = false;
  scene.drag = {};
  scene.time.step = 0.005;
  scene.guard.speed = 1e6;
  SceneRun run(table1_specimen(), scene);
  State state = rest_state(run.model);
  constexpr double arms = 20, degree = 0.017453292519943295;  // cm, rad
  int bends = 0;
  for (std::size_t k = 0; k < run.model.hinges.size(); ++k) {
    const Hinge& hinge = run.model.hinges[k];
    if (hinge.axis == Axis::y && hinge.body >= 23 && bends < 3) {
      const auto i = static_cast<Eigen::Index>(k) + root_dofs;
      state.q[i + 1] = 55 * degree;
      state.qdot[i] = speed / arms / 3;
      ++bends;
    }
  }
  run.sim = start_from(run.model, scene, "active-set", state, {}, 0);
  return run;
}

class ClosingArms : public testing::TestWithParam<double> {};

TEST_P(ClosingArms, NeverPassThroughEachOther) {
  SceneRun run = closing_arms(GetParam());
  const Scene& scene = run.scene;
  const Model& model = run.model;
  double deepest = 0, deepest_end = 0;
  int held = 0;
  bool shortened = false;
  for (int k = 0; k < 200; ++k) {
    const StepRecord& record = run.step();
    const auto& [state, seen] = run.sim.now;
    deepest = std::max(deepest, deepest_on_way(model, scene, record, state, 100));
    deepest_end = std::max(deepest_end, seen.penetration);
    held += record.solution.force[RowKind::contact].isZero() ? 0 : 1;
    // Closes to rounding, steps that end early included.
    EXPECT_LT(std::abs(run.sim.ledger.imbalance()), 1e-9 * run.sim.ledger.initial) << "step " << k;
    shortened = shortened || record.left_out > 0;
    const double travelled = scene.time.step - record.left_out;
    // Of the whole as one rigid body momentum decides (core/run/momentum.hpp).
    EXPECT_LE((advance(record.after.state.q, record.solution.qdot, travelled) - state.q)
                  .tail(model.nv() - root_dofs)
                  .lpNorm<Eigen::Infinity>(),
              1e-12);
  }
  // Two thin strands are 1.3 cm apart at their centres when they touch. What looks `stride` apart
  // may miss is a small share of it.
  EXPECT_LT(deepest, 0.1);
  // A step's end is seen in the log, however fast it came there.
  EXPECT_LE(deepest_end, 3 * scene.constraints.tolerance);
  EXPECT_GT(held, 0);
  if (GetParam() >= 10000) {
    EXPECT_TRUE(shortened);  // no row can see so far
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, ClosingArms, testing::Values(10, 100, 1000, 10000));

}  // namespace hagfish::look_ahead_test
