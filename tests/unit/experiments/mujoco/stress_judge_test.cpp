#include "experiments/mujoco/stress_judge.hpp"

#include <gtest/gtest.h>

#include "tests/support/stored_states.hpp"

namespace hagfish::stress_judge_test {

/// A judge of two straight bodies' worth of scene, shown steps by hand.
class StressJudgeTest : public testing::Test, protected ResolvedScene {
 protected:
  StressJudgeTest()
      : ResolvedScene(stored_scene({"expect.knot=", "expect.slide_distance=0", "wall.present=false",
                                    "expect.penetration=0.1", "expect.energy_gain=0.01"})),
        state(rest_state(model)),
        judge(model, scene, state, 100) {}

  /// Shows a step to where the judge already is, with figures of its own.
  void show(double penetration, double limit_violation, const EnergyState& energy) {
    Observation observation = observe(model, state, scene);
    observation.penetration = penetration;
    observation.limit_violation = limit_violation;
    judge.see(state, state, observation, 0.002, energy);
  }

  State state;
  StressJudge judge;
};

TEST_F(StressJudgeTest, NothingWrongIsOk) {
  show(0.09, 1e-5, {150, 50});  // 50 erg put in, and all there
  EXPECT_EQ(judge.ended().outcome, Outcome::ok);
  EXPECT_EQ(judge.ended().message, "");
}

TEST_F(StressJudgeTest, EnergyAboveWhatWasPutInIsGain) {
  show(0, 0, {152, 50});                                       // 2 of 150
  EXPECT_NEAR(judge.figures().energy_gain, 2.0 / 150, 1e-15);  // one rounding
  EXPECT_EQ(judge.ended().outcome, Outcome::energy_gain);
}

TEST_F(StressJudgeTest, PenetrationComesBeforeLimits) {
  show(0, 0.1, {100, 0});
  EXPECT_EQ(judge.ended().outcome, Outcome::limits);
  show(0.2, 0, {100, 0});
  EXPECT_EQ(judge.ended().outcome, Outcome::penetration);
  EXPECT_EQ(judge.ended().message, "penetration 0.2 cm (at most 0.1)");
}

TEST_F(StressJudgeTest, ACauseIsItsOwnOutcome) {
  for (const Outcome cause : {Outcome::non_finite, Outcome::penetration, Outcome::limits,
                              Outcome::speed, Outcome::energy_gain, Outcome::infeasible,
                              Outcome::solver_failed, Outcome::never_tied, Outcome::knot_lost}) {
    const Status status = judge.stopped(StepError({cause, "why"}));
    EXPECT_EQ(status.outcome, cause) << outcome_name(cause);
    EXPECT_EQ(status.message, "why");
  }
}

TEST_F(StressJudgeTest, AStopBySpeedAfterEnergyGainIsEnergyGain) {
  show(0, 0, {1e6, 0});
  EXPECT_EQ(judge.stopped(StepError({Outcome::speed, "fast"})).outcome, Outcome::energy_gain);
  EXPECT_EQ(judge.stopped(StepError({Outcome::knot_lost, "gone"})).outcome, Outcome::energy_gain);
  EXPECT_EQ(judge.stopped(StepError({Outcome::infeasible, "rows"})).outcome, Outcome::infeasible);
}

TEST_F(StressJudgeTest, StrandsThatPassWithinAStepTunnel) {
  // A loop whose tail lies above the front of the body, and then below: both ends of the step are
  // free of overlap.
  const auto loop = [&](double lift) {
    StartSettings settings;
    settings.bend = {{0.2, 0, 0, 0},       {0.2001, 0, lift, 0}, {0.28, 0, lift, 0},
                     {0.2801, 0, 0, 0.25}, {0.7246, 0, 0, 0.25}, {0.7247, 0, 0, 0}};
    return start_state(model, settings);
  };
  const State before = loop(0.3);
  State after = loop(-0.3);
  after.qdot.tail(model.nv() - root_dofs) =
      (after.q - before.q).tail(model.nv() - root_dofs) / scene.time.step;
  const Observation observation = observe(model, after, scene);
  ASSERT_EQ(observe(model, before, scene).penetration, 0);
  ASSERT_EQ(observation.penetration, 0);
  judge.see(before, after, observation, 0.002, {100, 0});
  EXPECT_EQ(judge.ended().outcome, Outcome::tunnelled);
}

TEST_F(StressJudgeTest, AKnotThatChangesItsTypeComesUndone) {
  ResolvedScene tied = stored_scene();
  tied.scene.start.phase = Phase::slide;
  StressJudge watch(model, tied.scene, stored_state("slide").state, 100);
  EXPECT_EQ(watch.figures().knot, "3_1");
  watch.see(state, state, observe(model, state, tied.scene), 1, {100, 0});
  EXPECT_EQ(watch.figures().knot, "0_1");
  EXPECT_EQ(watch.ended().outcome, Outcome::knot_lost);
  EXPECT_EQ(watch.ended().message, "3_1 became 0_1 at 1 s");
}

TEST_F(StressJudgeTest, AScriptThatNeverTiesIsNamed) {
  const ResolvedScene untied = stored_scene();
  EXPECT_EQ(StressJudge(model, untied.scene, state, 0).ended().outcome, Outcome::never_tied);
}

TEST_F(StressJudgeTest, AKnotThatDoesNotSlideIsCapped) {
  ResolvedScene stuck = stored_scene();
  stuck.scene.start.phase = Phase::slide;
  const StressJudge judge_of_it(model, stuck.scene, stored_state("slide").state, 0);
  EXPECT_EQ(judge_of_it.ended().outcome, Outcome::capped);
  EXPECT_EQ(judge_of_it.ended().message, "no slide");
}

}  // namespace hagfish::stress_judge_test
