// What the animal does when it ties itself: nothing outside takes part, and the start is forgotten.
// That the living scenes tie, hold, slide and come off: knot_scenes_test.cpp.
#include <gtest/gtest.h>

#include "tests/support/scene_run.hpp"

namespace hagfish::living_scenes_test {

TEST(LivingScenes, NothingOutsideTakesPartWhereTheHeadIsFree) {
  SceneRun run("living_figure_eight_free");
  double most = 0;
  while (!run.over()) {
    const StepSolution& step = run.step().solution;
    // Exactly: the torques of muscles are between bodies.
    ASSERT_TRUE(step.active_torque.head<root_dofs>().isZero(0));
    ASSERT_TRUE(step.tip.isZero(0));
    ASSERT_TRUE(step.force[RowKind::head].isZero(0));
    ASSERT_TRUE(step.force[RowKind::obstacle].isZero(0));
    most = std::max(most, step.active_torque.lpNorm<Eigen::Infinity>());
  }
  EXPECT_EQ(run.phase(), Phase::free);
  EXPECT_GT(most, 1e5);  // dyn cm: it is not nothing that ties the knot
  EXPECT_LE(most, 1.01 * run.scene.active.capacity);
  EXPECT_TRUE(run.sim.momentum.outside.linear.isZero(0));
  EXPECT_TRUE(run.sim.momentum.outside.angular.isZero(0));
}

TEST(LivingScenes, TheStartIsForgotten) {
  const auto centres = [](double time, unsigned seed) {
    SceneRun run("living_double_overhand", {seed == 0 ? "start.noise_deg=0" : "start.noise_deg=3",
                                            "start.seed=" + std::to_string(seed)});
    while (run.time() < time) run.step();
    return run.sim.now.observation.kin.centre;
  };
  for (const unsigned seed : {1U, 2U}) {
    const auto apart = [&](double time) {
      return (centres(time, seed) - centres(time, 0)).colwise().norm().maxCoeff();
    };
    EXPECT_GT(apart(0), 5);        // cm
    EXPECT_LT(apart(17), 1e-3);    // the end of the program
    EXPECT_LT(apart(19.5), 1e-3);  // while the knot slides
  }
}

}  // namespace hagfish::living_scenes_test
