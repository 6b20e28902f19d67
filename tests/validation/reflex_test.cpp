// The reflex on whole animals: it slides each knot, and what is taken from it keeps it from that;
// MuJoCo slides the same knot by it at the same speed.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "mujoco_ref/closed_loop.hpp"
#include "tests/support/scene_run.hpp"

namespace hagfish::reflex_test {

/// To the first step of the slide.
SceneRun tied(SceneRun run) {
  while (run.phase() != Phase::slide) run.step();
  return run;
}

double head_end(const SceneRun& run) {
  return knot_span(run.sim.controller).value_or(KnotSpan{}).head_end;
}

/// Where each joint copies itself, the knot stays; where it copies its neighbour, it goes 5 cm.
TEST(ReflexKnockedOut, MovesNoKnot) {
  SceneRun whole = tied(SceneRun("reflex_overhand"));
  SceneRun still = whole;
  still.scene.controller.law = own_law;
  still.sim.law = [&](const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
    control.rest_shape.setZero(at.model.nv());
    const Eigen::Index hinges = at.model.nv() - root_dofs;
    control.rest_shape.tail(hinges) =
        at.now.state.q.tail(hinges) + still.scene.time.step * at.now.state.qdot.tail(hinges);
  };
  const double from = head_end(whole);
  while (head_end(whole) > from - 5) {
    whole.step();
    still.step();
    ASSERT_EQ(whole.phase(), Phase::slide);
  }
  ASSERT_EQ(still.phase(), Phase::slide);
  EXPECT_LT(std::abs(knot_span(still.sim.controller)->head_end - from), 0.5);
}

/// By activations that lag 0.1 s behind, each knot.
class ReflexOfMuscles : public testing::TestWithParam<const char*> {};

TEST_P(ReflexOfMuscles, TiesHoldsSlidesAndComesOff) {
  SceneRun run(GetParam(), {"controller.law=reflex_muscles", "muscle.present=true",
                            "muscle.activation_time=0.1", "controller.reflex.shift=0.05"});
  while (!run.over()) {
    run.step();
    ASSERT_TRUE(run.record.control.rest_shape.size() == 0 &&
                run.record.control.thigmotaxis.empty());
  }
  EXPECT_EQ(run.phase(), Phase::free);  // a knot that is lost before its release ends the run
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, ReflexOfMuscles,
                         testing::Values("reflex_overhand", "reflex_figure_eight",
                                         "reflex_double_overhand", "reflex_three_twist"),
                         [](const auto& scene) { return std::string(scene.param); });

/// From the start of the slide, in both simulators: the knot holds and takes as long to the head.
TEST(ReflexInMujoco, SlidesAKnotAsFast) {
  SceneRun core = tied(SceneRun("reflex_double_overhand", {"wall.present=false"}));
  const auto step = std::llround(core.time() / 0.001);
  core.scene.time.step = 0.001;
  core.sim = start_from(core.model, core.scene, "active-set", core.sim.now.state,
                        core.sim.controller, step);
  SceneRun other = core;
  MujocoLoop mujoco(other.model, other.scene);
  const auto duration = [](SceneRun& run, const auto& take) {
    const double from = run.time();
    while (run.phase() == Phase::slide) take();  // throws where the knot is lost
    EXPECT_EQ(run.phase(), Phase::release);
    return run.time() - from;
  };
  const double here = duration(core, [&] { core.step(); });
  const double there = duration(other, [&] { mujoco.take_step(other.sim, other.record); });
  EXPECT_NEAR(there / here, 1, 0.1);
}

}  // namespace hagfish::reflex_test
