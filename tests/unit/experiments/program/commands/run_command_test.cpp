// `hagfish run` and `scenes` from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/log/reading/log_contents.hpp"
#include "tests/support/program_runs.hpp"

namespace hagfish::run_command_test {

namespace fs = std::filesystem;

TEST_F(ProgramTest, APresetComesBeforeSetAndQp) {
  const auto written = [this](const std::string& arguments) {
    const ProgramOutcome run = run_program(brief_run + "--force --out a.h5 " + arguments);
    EXPECT_EQ(run.code, 0) << arguments << ": " << run.output;
    const LogContents log((folder / "a.h5").string());
    return std::pair(log.resolved.scene.time.step, log.h5.root_text("qp"));
  };
  EXPECT_EQ(written(""), std::pair(0.005, std::string("active-set")));
  EXPECT_EQ(written("--preset quick"), std::pair(0.01, std::string("active-set")));
  EXPECT_EQ(written("--preset quick --set time.step=0.02").first, 0.02);
  EXPECT_EQ(written("--preset quick --qp ipopt").second, "ipopt");
}

TEST_F(ProgramTest, RunsEveryBodyCount) {
  for (const char* bodies : {"2", "3", "25", "400"}) {
    const ProgramOutcome run =
        run_program(brief_run + "--force --out n.h5 --set model.bodies=" + bodies);
    EXPECT_EQ(run.code, 0) << bodies << ": " << run.output;
  }
}

TEST_F(ProgramTest, RefusesBadInputInOneLine) {
  expect_refused("run --set time.frame_interval=0.007", {"time.frame_interval"});
  expect_refused("run --set expect.knot=unknot", {"expect.knot"});
  expect_refused("run --set controller.contact_gap=1", {"controller.contact_gap"});
  expect_refused("run --qp none", {"--qp", "ipopt"});
  expect_refused("run specimens/pacific_hagfish", {"scenes"});
}

TEST_F(ProgramTest, AFailedStepLeavesAReadableLogWithTheCause) {
  // Joints of a body pulled this hard move faster than the guard allows.
  const ProgramOutcome run = run_program("run --quiet --set guard.speed=5 --out a.h5");
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_NE(run.output.find("failed: body"), std::string::npos) << run.output;
  const ProgramOutcome info = run_program("info a.h5");
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.output.find("failed: body"), std::string::npos) << info.output;
  EXPECT_NE(info.output.find("at step"), std::string::npos) << info.output;
  EXPECT_EQ(run_program("check a.h5").code, 1);
}

/// A script that ends after a second, long before anything is tied.
const std::string hasty =
    "run --qp active-set --set script.kind=position --set script.spring=3000 --set "
    "script.largest_force=500 --set script.unit=L --set "
    "'script.knots=[[0, 0.995, 0, 0], [1, 0.95, 0.05, 0]]' --set time.step=0.02 ";

TEST_F(ProgramTest, AScriptThatTiesNothingEndsWithCode3AndSaysSo) {
  const ProgramOutcome run = run_program(hasty + "--quiet --out a.h5");
  EXPECT_EQ(run.code, 3) << run.output;
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  EXPECT_NE(
      run.output.find("a.h5: failed: the script ended with no knot (none was tied before), but "
                      "expect.knot = 3_1"),
      std::string::npos)
      << run.output;
  EXPECT_EQ(run_program("check a.h5").code, 1);
  const ProgramOutcome none = run_program(hasty +
                                          "--quiet --force --out a.h5 --set expect.knot= --set "
                                          "time.duration=3.5");
  EXPECT_EQ(none.code, 0) << none.output;
}

TEST_F(ProgramTest, StopsWhenAPhaseHasEndedAndTellsTheKnotAsItGoes) {
  const ProgramOutcome run = run_program("run --preset quick --until form --out a.log");
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_NE(run.output.find(" s  overhand, 3_1  "), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("tighten  t = "), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("slide    t = "), std::string::npos) << run.output;
  {
    const LogContents log((folder / "a.log").string());
    EXPECT_EQ(log.resolved.scene.time.until, Phase::form);  // a rerun stops there too
    EXPECT_GT(log.time.back(), 9);
  }
  // What was not reached is not judged.
  const ProgramOutcome check = run_program("check a.log --all");
  EXPECT_EQ(check.code, 0) << check.output;
  EXPECT_EQ(check.output.find("slide"), std::string::npos) << check.output;
  expect_refused("run --until tied --out b.h5", {"time.until=tied", "must be one of", "tighten"});
}

TEST_F(ProgramTest, ListsTheScenes) {
  const ProgramOutcome scenes = run_program("scenes");
  EXPECT_EQ(scenes.code, 0);
  EXPECT_NE(scenes.output.find("table1"), std::string::npos);
  EXPECT_NE(scenes.output.find("overhand_waypoints"), std::string::npos);
}

}  // namespace hagfish::run_command_test
