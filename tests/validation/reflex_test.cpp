// The reflex on whole animals: it slides each knot, and what is taken from it keeps it from that;
// MuJoCo slides the same knot by it at the same speed.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/run/simulation.hpp"
#include "mujoco_ref/closed_loop.hpp"

namespace hagfish::reflex_test {

/// A run of a built-in scene.
struct ReflexRun {
  explicit ReflexRun(const std::string& name, const std::vector<std::string>& set = {})
      : resolved(read_scene(std::string(HAGFISH_DATA_DIR) + "/" + name + ".toml", set)),
        model(make_hagfish(resolved.specimen, resolved.scene)),
        sim(start(model, resolved.scene, "active-set")) {}
  void step() { take_step(model, resolved.scene, sim, record); }
  Phase phase() const { return sim.controller.phase; }
  double head_end() const { return knot_span(sim.controller).value_or(KnotSpan{}).head_end; }
  double time() const { return time_of(sim, resolved.scene); }
  /// To the first step of the slide.
  void slide() {
    while (phase() != Phase::slide) step();
  }

  ResolvedScene resolved;
  Model model;
  Simulation sim;
  StepRecord record;
};

/// Where each joint copies itself, the knot stays; where it copies its neighbour, it goes 5 cm.
TEST(ReflexKnockedOut, MovesNoKnot) {
  ReflexRun whole("reflex_overhand");
  whole.slide();
  Simulation still = whole.sim;
  Scene own = whole.resolved.scene;
  own.controller.law = own_law;
  still.law = [&](const Situation& at, Eigen::VectorXd& /*memory*/, Control& control) {
    control.rest_shape.setZero(whole.model.nv());
    const Eigen::Index hinges = whole.model.nv() - root_dofs;
    control.rest_shape.tail(hinges) =
        at.now.state.q.tail(hinges) + own.time.step * at.now.state.qdot.tail(hinges);
  };
  const double from = whole.head_end();
  StepRecord record;
  while (whole.head_end() > from - 5) {
    whole.step();
    take_step(whole.model, own, still, record);
    ASSERT_EQ(whole.phase(), Phase::slide);
  }
  ASSERT_EQ(still.controller.phase, Phase::slide);
  EXPECT_LT(std::abs(knot_span(still.controller)->head_end - from), 0.5);
}

/// By activations that lag 0.1 s behind, each knot.
class ReflexOfMuscles : public testing::TestWithParam<const char*> {};

TEST_P(ReflexOfMuscles, TiesHoldsSlidesAndComesOff) {
  ReflexRun run(GetParam(), {"controller.law=reflex_muscles", "muscle.present=true",
                             "muscle.activation_time=0.1", "controller.reflex.shift=0.05"});
  while (!finished(run.sim, run.resolved.scene)) {
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
  ReflexRun tied("reflex_double_overhand", {"wall.present=false"});
  tied.slide();
  ResolvedScene fine = tied.resolved;
  fine.scene.time.step = 0.001;
  Simulation core = start_from(tied.model, fine.scene, "active-set", tied.sim.now.state,
                               tied.sim.controller, std::llround(tied.time() / 0.001));
  Simulation other = core;
  MujocoLoop mujoco(tied.model, fine.scene);
  const auto duration = [&](Simulation& sim, const auto& take) {
    StepRecord record;
    const double from = time_of(sim, fine.scene);
    while (sim.controller.phase == Phase::slide)
      take(sim, record);  // throws where the knot is lost
    EXPECT_EQ(sim.controller.phase, Phase::release);
    return time_of(sim, fine.scene) - from;
  };
  const double here = duration(core, [&](Simulation& sim, StepRecord& record) {
    take_step(tied.model, fine.scene, sim, record);
  });
  const double there =
      duration(other, [&](Simulation& sim, StepRecord& record) { mujoco.take_step(sim, record); });
  EXPECT_NEAR(there / here, 1, 0.1);
}

}  // namespace hagfish::reflex_test
