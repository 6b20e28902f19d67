// `hagfish mjcf`, `compare`, `integrate` and `stress` from outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/program_runs.hpp"

namespace hagfish::mujoco_commands_test {

namespace fs = std::filesystem;

TEST_F(ProgramTest, WritesMjcf) {
  const std::string write = "mjcf --set model.bodies=100 --out model ";
  EXPECT_EQ(run_program(write).code, 0);
  EXPECT_TRUE(fs::exists(folder / "model/hagfish.xml"));
  EXPECT_TRUE(fs::exists(folder / "model/hagfish_bodies_80.xml"));
  EXPECT_EQ(run_program(write + "--force --clamp").code, 0);
}

TEST_F(ProgramTest, ComparesWithMujoco) {
  const ProgramOutcome compare = run_program("compare --set model.bodies=3 --out compare.h5");
  EXPECT_EQ(compare.code, 0) << compare.output;
  EXPECT_NE(compare.output.find("acceleration"), std::string::npos) << compare.output;
  EXPECT_EQ(compare.output.find("FAIL"), std::string::npos) << compare.output;
  EXPECT_TRUE(fs::exists(folder / "compare.h5"));
  fs::remove(folder / "compare.h5");
  expect_refused("compare --set model.bodies=1", {"model.bodies"});
  // Steps longer than what is compared, and steps without end.
  for (const std::string step : {"3", "1e-07"}) {
    expect_refused("compare --set model.bodies=3 --set time.frame_interval=3 --set time.step=" +
                       step + " --out compare.h5",
                   {"time.step = " + step, "1 to 100000 steps"});
    EXPECT_FALSE(fs::exists(folder / "compare.h5"));
  }
}

TEST_F(ProgramTest, IntegratesSmoothMotions) {
  const ProgramOutcome whip =
      run_program("integrate --set model.bodies=3 --motion whip --out whip.h5");
  EXPECT_EQ(whip.code, 0) << whip.output;
  EXPECT_NE(whip.output.find("MuJoCo RK4"), std::string::npos) << whip.output;
  EXPECT_TRUE(fs::exists(folder / "whip.h5"));
  fs::remove(folder / "whip.h5");
  expect_refused("integrate --motion jump --out i.h5", {"--motion", "jump", "coil, hanging, whip"});
}

TEST_F(ProgramTest, StressNamesTheOutcomeOfACell) {
  const std::string cell =
      "stress table1 --step 0.02 --level \"short, and so untied\" --set time.duration=0.1 ";
  const ProgramOutcome shown = run_program(cell);
  EXPECT_EQ(shown.code, 0) << shown.output;
  EXPECT_EQ(shown.output.rfind("scene,level,method,h_ms,outcome,time_s,energy_gain,", 0), 0u);
  EXPECT_NE(shown.output.find("\ntable1,\"short, and so untied\",default,20,never tied,0.1,0,"),
            std::string::npos)
      << shown.output;
  EXPECT_EQ(run_program(cell + "--out cell.csv").output, "");
  EXPECT_TRUE(fs::exists(folder / "cell.csv"));
  expect_refused("stress table1 --method mujoco_euller", {"did you mean `mujoco_euler`?"});
}

}  // namespace hagfish::mujoco_commands_test
