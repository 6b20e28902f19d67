// `hagfish info` and `check` from outside.
#include <H5Cpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "tests/support/program_runs.hpp"

namespace hagfish::log_commands_test {

/// What a log holds of a run that never got to this or that.
const std::regex no_number(R"((^|[^a-z])-?(inf|nan)([^a-z]|$))");

class LogCommandsTest : public ProgramTest {
 protected:
  std::string text_of(const std::string& name) const { return read_text_file(folder / name); }

  /// Runs `arguments` into a.h5, which `check` must fail with every one of `parts`, and neither
  /// command may print a number that is none.
  void expect_told(const std::string& arguments, int code, const std::vector<std::string>& parts) {
    const ProgramOutcome run = run_program("run --quiet --force --out a.h5 " + arguments);
    ASSERT_EQ(run.code, code) << run.output;
    const ProgramOutcome check = run_program("check a.h5 --all --csv a.csv");
    EXPECT_EQ(check.code, 1) << check.output;
    for (const std::string& part : parts) {
      EXPECT_NE(check.output.find(part), std::string::npos) << part << " in " << check.output;
    }
    const std::string text = check.output + run_program("info a.h5").output +
                             run_program("info --json a.h5").output + text_of("a.csv");
    EXPECT_FALSE(std::regex_search(text, no_number)) << text;
  }
};

TEST_F(LogCommandsTest, AProgramMadeOfALogRuns) {
  const std::string brief =
      "run living_overhand --qp active-set --quiet --force --set time.duration=1 "
      "--set time.step=0.01 --set expect.types=[] ";
  const ProgramOutcome first = run_program(brief + "--out a.h5");
  ASSERT_EQ(first.code, 0) << first.output;
  const ProgramOutcome made = run_program("program a.h5 --out p.csv --stations 5 --times 6");
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_EQ(made.output.find("p.csv: 5 stations x 6 times, "), 0u) << made.output;
  EXPECT_NE(made.output.find("rms error "), std::string::npos) << made.output;
  const ProgramOutcome again = run_program(
      brief + "--out b.h5 --set script.program=p.csv --set controller.tighten_from=0.5");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(run_program("program a.h5 --out q.csv --stations 26").code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "q.csv"));
}

TEST_F(LogCommandsTest, OfARunThatNeverTiesTellSo) {
  expect_told("--set time.duration=0.02 --set expect.hand=right", 0,
              {"FAIL knot held                never tied: no frame with a knot (overhand, 3_1)\n",
               "FAIL hand                     never tied: no frame with a knot (overhand, 3_1)\n",
               "the log, of 0 to 0.02 s, has no frame with a knot (overhand, 3_1) from tighten to "
               "release\n",
               "FAIL slide                    no slide (at least 9 cm)\n",
               "FAIL Eq. 6                    no sliding steps (at least 95 %)\n",
               "ok   contacts followed        no contact was followed\n"});
}

TEST_F(LogCommandsTest, OfARunThatTiesButNeverTightensTellSo) {
  // The script ties after 9 s; this much tail is never through.
  expect_told("--preset quick --set controller.tail_through=40 --set time.duration=11", 0,
              {"FAIL knot held                never tightened, though a knot (overhand, 3_1) at ",
               "FAIL hand                     never tightened, though a knot (overhand, 3_1) at ",
               "FAIL slide                    no slide (at least 9 cm)\n"});
}

TEST_F(LogCommandsTest, OfARunThatEndsWhileItTightensTellThatThereIsNoSlide) {
  expect_told("--preset quick --set time.duration=11", 0,
              {"ok   knot held  ", "FAIL slide                    no slide (at least 9 cm)\n",
               "FAIL Eq. 6                    no sliding steps (at least 95 %)\n"});
}

TEST_F(LogCommandsTest, OfARunThatNeverTurnsTellThatThereIsNoWayBack) {
  expect_told("overhand_reverse --preset quick --set time.duration=1", 0,
              {"FAIL reverse                  no reverse (at least "});
}

TEST_F(LogCommandsTest, CheckWritesARowForEachLogAndCriterion) {
  ASSERT_EQ(run_program(brief_run + "--out a.h5").code, 0);
  // Euler's rule loses 0.19 of the energy in the first 4 steps from rest.
  const std::string no_knot = "--set expect.knot= --set expect.energy_loss=0.2 ";
  ASSERT_EQ(run_program(brief_run + no_knot + "--out b.h5").code, 0);
  const ProgramOutcome one = run_program("check b.h5 --csv b.csv");
  EXPECT_EQ(one.code, 0) << one.output;
  EXPECT_EQ(one.output.rfind("ok   status", 0), 0u)
      << "no heading for a single log: " << one.output;
  EXPECT_EQ(std::ranges::count(one.output, '\n'), 10) << one.output;
  EXPECT_NE(one.output.find("bit by bit\nok   "), std::string::npos) << one.output;
  EXPECT_GT(std::ranges::count(run_program("check b.h5 --all").output, '\n'), 10);
  const ProgramOutcome both = run_program("check b.h5 a.h5 --csv a.csv");
  EXPECT_EQ(both.code, 1) << both.output;
  EXPECT_EQ(run_program("check a.h5 b.h5").code, 1) << "in this order too";
  EXPECT_NE(both.output.find("b.h5:\nok   status"), std::string::npos) << both.output;
  EXPECT_NE(both.output.find("\na.h5:\nFAIL knot held"), std::string::npos) << both.output;
  EXPECT_NE(both.output.find("hagfish: a.h5: check failed: "), std::string::npos) << both.output;
  EXPECT_EQ(both.output.find("hagfish: b.h5:"), std::string::npos) << both.output;

  const std::vector<Cells> rows = csv_cells(folder / "a.csv");
  ASSERT_GT(rows.size(), 2u);
  EXPECT_EQ(rows[0], (Cells{"log", "criterion", "value", "bound", "unit", "met"}));
  EXPECT_EQ(rows[1], (Cells{"b.h5", "status", "complete", "complete", "", "yes"}));
  const auto has = [&rows](const Cells& row) { return std::ranges::count(rows, row) == 1; };
  EXPECT_TRUE(has({"a.h5", "slide", "", "9", "cm", "no"})) << text_of("a.csv");
  EXPECT_TRUE(has({"a.h5", "penetration", "0", "0.001", "cm", "yes"})) << text_of("a.csv");
  EXPECT_TRUE(has({"a.h5", "knot held", "", "", "frames", "no"})) << text_of("a.csv");
  EXPECT_TRUE(has({"b.h5", "f_thigmo past the knot", "0", "0", "dyn cm", "yes"}));
  // As many verdicts of each kind as the table for people has.
  std::size_t no = 0;
  for (const Cells& row : rows) no += row.back() == "no" ? 1 : 0;
  std::size_t told = 0;
  for (std::size_t at = 0; (at = both.output.find("\nFAIL ", at)) != std::string::npos; ++at)
    ++told;
  EXPECT_EQ(no, told);
}

TEST_F(LogCommandsTest, ALogThatCannotBeReadDoesNotLoseTheOthers) {
  ASSERT_EQ(run_program(brief_run + "--out a.h5").code, 0);
  const ProgramOutcome check = run_program("check none.h5 a.h5 --csv a.csv");
  EXPECT_EQ(check.code, 2) << check.output;
  EXPECT_NE(check.output.find("hagfish: none.h5: no such file\n"), std::string::npos);
  EXPECT_NE(check.output.find("hagfish: a.h5: check failed: "), std::string::npos) << check.output;
  EXPECT_NE(text_of("a.csv").find("\na.h5,slide,"), std::string::npos);
}

TEST_F(LogCommandsTest, InfoGivesJson) {
  ASSERT_EQ(run_program(brief_run + "--set time.step=0.005 --out a.h5").code, 0);
  const ProgramOutcome info = run_program("info --json a.h5 a.h5");
  ASSERT_EQ(info.code, 0) << info.output;
  const auto logs = nlohmann::json::parse(info.output);
  ASSERT_EQ(logs.size(), 2u);
  EXPECT_EQ(logs[0], logs[1]);
  const nlohmann::json& log = logs[0];
  EXPECT_EQ(log["log"], "a.h5");
  EXPECT_EQ(log["status"], "complete");
  EXPECT_EQ(log["bodies"], 100);
  EXPECT_EQ(log["step_s"], 0.005);
  EXPECT_EQ(log["steps"], 4);
  EXPECT_EQ(log["frames"], Hdf5Reader(folder / "a.h5").doubles("/trajectory/time").size());
  ASSERT_EQ(log["phases"].size(), 1u);
  EXPECT_EQ(log["phases"][0]["phase"], "form");
  EXPECT_EQ(log["phases"][0]["knot"], "0_1");
  EXPECT_TRUE(log["phases"][0]["head_end_cm"].is_null()) << "no contact yet";
  const ProgramOutcome both = run_program("info a.h5 a.h5");
  EXPECT_NE(both.output.find("a.h5:\nstatus "), std::string::npos) << both.output;
}

}  // namespace hagfish::log_commands_test
