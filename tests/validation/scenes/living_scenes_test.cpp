// What the animal does when it ties itself: nothing outside takes part, and the start is forgotten.
// That the living scenes tie, hold, slide and come off: knot_scenes_test.cpp.
#include <gtest/gtest.h>

#include "core/input/files/scene_reader.hpp"
#include "core/run/simulation.hpp"

namespace hagfish::living_scenes_test {

ResolvedScene scene_called(const std::string& name, const std::vector<std::string>& set = {}) {
  return read_scene(std::string(HAGFISH_DATA_DIR) + "/" + name + ".toml", set);
}

TEST(LivingScenes, NothingOutsideTakesPartWhereTheHeadIsFree) {
  const ResolvedScene resolved = scene_called("living_figure_eight_free");
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Simulation sim = start(model, resolved.scene, "active-set");
  StepRecord record;
  double most = 0;
  while (!finished(sim, resolved.scene)) {
    take_step(model, resolved.scene, sim, record);
    const StepSolution& step = record.solution;
    // Exactly: the torques of muscles are between bodies.
    ASSERT_TRUE(step.active_torque.head<root_dofs>().isZero(0));
    ASSERT_TRUE(step.tip.isZero(0));
    ASSERT_TRUE(step.force[RowKind::head].isZero(0));
    ASSERT_TRUE(step.force[RowKind::obstacle].isZero(0));
    most = std::max(most, step.active_torque.lpNorm<Eigen::Infinity>());
  }
  EXPECT_EQ(sim.controller.phase, Phase::free);
  EXPECT_GT(most, 1e5);  // dyn cm: it is not nothing that ties the knot
  EXPECT_LE(most, 1.01 * resolved.scene.active.capacity);
  EXPECT_TRUE(sim.momentum.outside.linear.isZero(0));
  EXPECT_TRUE(sim.momentum.outside.angular.isZero(0));
}

/// The state at `time` of a clamped living scene from a start with `noise` (degrees).
State state_at(const std::string& name, double time, double noise, unsigned seed) {
  const ResolvedScene resolved = scene_called(
      name, {"start.noise_deg=" + std::to_string(noise), "start.seed=" + std::to_string(seed)});
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Simulation sim = start(model, resolved.scene, "active-set");
  StepRecord record;
  while (time_of(sim, resolved.scene) < time) take_step(model, resolved.scene, sim, record);
  return sim.now.state;
}

TEST(LivingScenes, TheStartIsForgotten) {
  const ResolvedScene resolved = scene_called("living_double_overhand");
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  const auto centres = [&](double time, unsigned seed) {
    return kinematics(model, state_at("living_double_overhand", time, seed == 0 ? 0 : 3, seed))
        .centre;
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
