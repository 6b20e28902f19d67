// `hagfish record-qp` and `qp` from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "tests/support/foreign_qps.hpp"
#include "tests/support/program_runs.hpp"

namespace hagfish::qp_command_test {

// Ten steps, with joints that can hardly twist, so that limits are in reach from the first.
const std::string record =
    "record-qp --quiet --set specimen.twist_limit_deg=0.01 --set time.step=0.005 --set "
    "time.duration=0.05 --out ";

TEST_F(ProgramTest, RecordsQpsAndMeasuresBackEnds) {
  const ProgramOutcome recorded = run_program(record + "a.qps");
  EXPECT_EQ(recorded.code, 0);
  EXPECT_EQ(recorded.output, "a.qps: 10 QPs of 10 steps\n");
  const ProgramOutcome measured = run_program("qp a.qps --repeat 1 --csv a.csv");
  EXPECT_EQ(measured.code, 0) << measured.output;
  for (const char* part : {"10 QPs (0 primal) in 1 sequences", "10 stored, 0 carried over, 0 zero",
                           "\nipopt                    cold ", "\nactive-set               warm ",
                           "\nipopt-unpolished         warm "}) {
    EXPECT_NE(measured.output.find(part), std::string::npos) << part << " in " << measured.output;
  }
  std::ifstream csv(folder / "a.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("back_end,tolerance,start,qps,median_s,", 0), 0u) << line;
  const auto columns = std::count(line.begin(), line.end(), ',');
  int lines = 0;
  for (; std::getline(csv, line); ++lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
  }
  EXPECT_EQ(lines, 6);
  const ProgramOutcome chosen = run_program(
      "qp a.qps --backend ipopt-unpolished --tolerance 1e-4 --tolerance 1e-7 --repeat 1");
  EXPECT_EQ(chosen.code, 0) << chosen.output;
  EXPECT_NE(chosen.output.find("\nipopt-unpolished 1e-07   cold "), std::string::npos)
      << chosen.output;
  EXPECT_EQ(chosen.output.find("active-set"), std::string::npos) << chosen.output;
}

TEST_F(ProgramTest, RecordsPrimalQpsNowAndThen) {
  EXPECT_EQ(run_program(record + "a.qps --primal --every 4").output, "a.qps: 3 QPs of 10 steps\n");
  const ProgramOutcome measured = run_program("qp a.qps --backend active-set --repeat 1");
  EXPECT_EQ(measured.code, 0) << measured.output;
  EXPECT_NE(measured.output.find("3 QPs (3 primal) in 3 sequences"), std::string::npos)
      << measured.output;
}

TEST_F(ProgramTest, AFailedRunKeepsItsQps) {
  const ProgramOutcome run = run_program(
      "record-qp --quiet --set specimen.twist_limit_deg=0.01 --set guard.speed=5 --out a.qps");
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_NE(run.output.find("a.qps: the run failed: body"), std::string::npos) << run.output;
  EXPECT_EQ(run_program("qp a.qps --backend active-set --repeat 1").code, 0);
}

TEST_F(ProgramTest, InfeasibleQpsFail) {
  {
    ForeignQps set(folder / "a.qps");
    for (int i = 0; i < 20; ++i) {
      set.problem(std::to_string(i));
      i == 1 ? put_primal(set) : put_contradiction(set);
    }
  }
  const ProgramOutcome measured =
      run_program("qp a.qps --backend active-set --backend ipopt --repeat 1");
  EXPECT_EQ(measured.code, 1);
  const std::string& text = measured.output;
  EXPECT_NE(text.find("hagfish: a.qps: /qp/0: active-set, cold: infeasible (rows contradict"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("/qp/1:"), std::string::npos) << text;
  EXPECT_NE(text.find("hagfish: a.qps: and 66 more failures\n"), std::string::npos) << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 30) << "not a line for each: " << text;
}

TEST_F(ProgramTest, RefusesBadQpInputInOneLine) {
  {
    ForeignQps set(folder / "bad.qps");
    set.problem("7");
    put_primal(set);
    set.replace("d", {1, 2, 3});
  }
  expect_refused("qp bad.qps", {"bad.qps", "/qp/7", "C is 2 x 2, not 3 x 2"});
  expect_refused("qp bad.qps --backend none", {"--backend", "none"});
  expect_refused("qp bad.qps --tolerance 0", {"--tolerance"});
  expect_refused("qp bad.qps --repeat 0", {"--repeat"});
  expect_refused("qp", {"SET"});
  expect_refused("record-qp", {"--out"});
  expect_refused(record + "b.h5 --every 0", {"--every"});
  expect_refused(record + "b.h5 --qp none", {"--qp", "active-set"});
}

TEST_F(ProgramTest, RecordsQpsOfEulersRuleOnly) {
  expect_refused("record-qp --set time.rule=midpoint --out q.h5", {"time.rule", "euler"});
  EXPECT_FALSE(std::filesystem::exists(folder / "q.h5"));
}

}  // namespace hagfish::qp_command_test
