// Where nothing moves, or all moves alike, what an audit measures against vanishes: such logs pass.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/log/log_writer.hpp"
#include "experiments/audit/audit.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::standstill_test {

/// The animal of Table 1 in a scene of its own, with all that its audit may object to.
ResolvedScene scene_of(std::vector<std::string> set) {
  set.insert(set.end(), {"expect.knot=", "expect.types=[]", "expect.speed_share=0.0",
                         "time.frame_interval=0.1", "controller.law=own"});
  return stored_scene(set);
}

void no_commands(const Situation&, Eigen::VectorXd&, Control&) {}

/// What the audit says of 300 steps from the scene's start, by `law`.
std::string objections(SceneRun run, const ControlLaw& law = no_commands) {
  const TemporaryFolder folder;
  run.sim.law = law;
  write_log(folder / "log.h5", run, 300);
  return audit_objections(folder / "log.h5");
}

TEST(Standstill, OfAStraightBodyFreeClampedOrPulled) {
  EXPECT_EQ(objections(scene_of({"clamp_head=false", "wall.present=false"})), "");
  EXPECT_EQ(objections(scene_of({})), "");
  const ControlLaw pull = [](const Situation&, Eigen::VectorXd&, Control& control) {
    control.tip = {{500, 0, 0}, 0};
  };
  EXPECT_EQ(objections(scene_of({}), pull), "");
}

/// What the audit says of `steps` steps from the knot of Table 1's slide at rest, by `law`.
std::string objections_to_a_knot(const std::vector<std::string>& set, const ControlLaw& law,
                                 int steps) {
  const TemporaryFolder folder;
  SceneRun run(scene_of(set));
  StoredState knot = stored_state("slide");
  knot.phase = Phase::form;  // in which no knot is expected
  knot.state.qdot.setZero();
  const std::int64_t stride = frame_stride(run.scene.time);
  knot.step -= knot.step % stride;  // a log begins with a frame
  run.sim = resume(run.model, run.scene, knot);
  run.sim.law = law;
  write_log(folder / "log.h5", run, steps);
  return audit_objections(folder / "log.h5");
}

TEST(Standstill, OfAKnotThatNothingOrItsStiffnessAloneMoves) {
  const std::vector<std::string> limp = {"model.bending_stiffness=0.0",
                                         "model.twist_stiffness=0.0"};
  EXPECT_EQ(objections_to_a_knot({}, no_commands, 500), "");
  EXPECT_EQ(objections_to_a_knot(limp, no_commands, 500), "");
}

TEST(Standstill, OfAKnotPulledTight) {
  const auto pulled_by = [](double force, const std::vector<std::string>& set, int steps) {
    const ControlLaw pull = [force](const Situation&, Eigen::VectorXd&, Control& control) {
      control.tip = {{force, 0, 0}, 0};
    };
    return objections_to_a_knot(set, pull, steps);
  };
  EXPECT_EQ(pulled_by(1000, {}, 3000), "");
  // Strands lie along each other: there are minima that a search from nothing misses for good.
  EXPECT_EQ(pulled_by(2000, {}, 3000), "");
  // What Euler's rule loses while the knot jerks tight falls with the step: at 2 ms it is 0.14.
  EXPECT_EQ(pulled_by(3000, {"time.step=0.0005"}, 3000), "");
}

/// The audit's finding on the motion of a free body at rest, `size` times as long as the paper's
/// animal, that is a share `moved` of its length elsewhere for one frame.
Finding motion_of(double size, double moved) {
  const TemporaryFolder folder;
  ResolvedScene resolved = scene_of({"clamp_head=false", "wall.present=false"});
  Specimen& animal = resolved.specimen;
  animal.length *= size;
  animal.bending_span *= size;
  for (double& around : animal.circumference) around *= size;
  resolved.scene.contact.least_arc *= size;
  SceneRun run(animal, resolved.scene);
  run.sim.law = no_commands;
  write_log(folder / "log.h5", run, 300);
  rewrite<double>(
      folder / "log.h5", "/trajectory/q", H5::PredType::NATIVE_DOUBLE,
      [&](std::vector<double>& q) { q[3 * run.model.nq() + 1] += moved * animal.length; });
  std::vector<Finding> findings = audit(folder / "log.h5");
  return *std::ranges::find(findings, "motion", &Finding::name);
}

TEST(Standstill, OfBodiesOfAnyLengthIsJudgedAlike) {
  for (const double moved : {0.02, 0.04}) {
    const Finding own = motion_of(1, moved);
    EXPECT_EQ(own.passed, moved < 0.03) << own.text;
    for (const double size : {0.125, 8.0}) {
      const Finding other = motion_of(size, moved);
      EXPECT_EQ(other.value, own.value) << size;
      EXPECT_EQ(other.passed, own.passed) << size;
    }
  }
}

}  // namespace hagfish::standstill_test
