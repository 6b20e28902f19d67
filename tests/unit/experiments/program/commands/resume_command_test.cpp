// `hagfish run --resume` and `branch` from outside.
#include <gtest/gtest.h>
#include <cstring>

#include <filesystem>
#include <string>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "tests/support/program_runs.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::resume_command_test {

namespace fs = std::filesystem;

const std::string short_run = "run --quiet --qp active-set --set time.duration=0.4 ";

class ResumeTest : public ProgramTest {
 protected:
  Hdf5Reader log(const char* name) const { return Hdf5Reader(folder / name); }

  /// Rows `from` on of `whole` are all rows of `part`, to the last bit.
  static void expect_same_rows(const Hdf5Reader& whole, const Hdf5Reader& part,
                               const std::string& path, Eigen::Index from) {
    const Hdf5Reader::Rows a = whole.rows(path).bottomRows(whole.rows(path).rows() - from);
    const Hdf5Reader::Rows b = part.rows(path);
    ASSERT_EQ(a.rows(), b.rows()) << path;
    ASSERT_EQ(a.cols(), b.cols()) << path;
    EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * b.size()), 0) << path;
  }
};

TEST_F(ResumeTest, WhatCannotGoOnStaysAsItIs) {
  ASSERT_EQ(run_program(short_run + "--out a.h5").code, 0);
  const auto expect = [this](const std::string& arguments, const std::string& message) {
    const ProgramOutcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_EQ(outcome.output, "hagfish: " + message + "\n") << arguments;
  };
  expect("run --resume a.h5", "a.h5: the run is complete");
  expect("run --resume none.h5.part", "none.h5: no such file");
  expect("branch a.h5 --time -0.05 --out b.h5", "a.h5: begins at 0 s");
  expect("branch a.h5 --set model.bodies=50 --out b.h5",
         "a.h5: cannot branch at 0.4 s: the state has another number of bodies than the model");
  expect("branch a.h5 --time 0.1 --set time.step=0.03 --set time.frame_interval=0.03 --out b.h5",
         "a.h5: cannot branch at 0.1 s: its time, 0.1 s, is not a multiple of time.frame_interval "
         "= 0.03 s");
  expect("branch a.h5 --out b.h5",
         "a.h5: cannot branch at 0.4 s: the scene has ended by then (time.duration = 0.4 s; use "
         "--time for an earlier branch)");
  expect("branch a.h5 --time 0.1 --out a.h5", "a.h5: already exists (--force replaces it)");
  EXPECT_NE(run_program("run table1 --resume a.h5").output.find("--resume"), std::string::npos);
  fs::copy_file(folder / "a.h5", folder / "a.h5.part");
  EXPECT_EQ(run_program("run --resume a.h5.part").code, 2);
  EXPECT_TRUE(fs::exists(folder / "a.h5"));
  EXPECT_TRUE(fs::exists(folder / "a.h5.part"));
}

TEST_F(ResumeTest, ABranchWithoutChangesFollowsTheRun) {
  ASSERT_EQ(run_program(short_run + "--out a.h5").code, 0);
  const ProgramOutcome branch = run_program("branch a.h5 --time 0.21 --out b.h5 --quiet");
  ASSERT_EQ(branch.code, 0) << branch.output;
  EXPECT_EQ(log("b.h5").root_text("branched_from"), "a.h5, step 40, t = 0.2 s");
  for (const char* path : {"/trajectory/q", "/trajectory/qdot", "/forces/limit", "/forces/head",
                           "/diagnostics/work_tip", "/trajectory/time"}) {
    expect_same_rows(log("a.h5"), log("b.h5"), path, 10);
  }
  expect_same_rows(log("a.h5"), log("b.h5"), "/steps/kkt", 40);
}

TEST_F(ResumeTest, ABranchTakesOtherSettings) {
  ASSERT_EQ(run_program(short_run + "--out a.h5").code, 0);
  const ProgramOutcome branch = run_program(
      "branch a.h5 --time 0.2 --set model.bending_stiffness=1000 --set time.step=0.001 --set "
      "time.duration=0.6 --out b.h5 --quiet");
  ASSERT_EQ(branch.code, 0) << branch.output;
  const Hdf5Reader b = log("b.h5");
  EXPECT_EQ(b.integers("/trajectory/step").front(), 200);
  EXPECT_EQ(b.doubles("/trajectory/time").front(), 0.2);
  EXPECT_EQ(b.doubles("/trajectory/time").size(), 21u);
  EXPECT_EQ(b.rows("/trajectory/q").row(0), log("a.h5").rows("/trajectory/q").row(10));
  EXPECT_NE(b.root_text("scene").find("bending_stiffness = 1000"), std::string::npos);
  // All but what a run so short cannot show.
  const std::string check = run_program("check b.h5 --all").output;
  for (const char* finding : {"energy ledger", "force balance", "again"}) {
    EXPECT_NE(check.find(std::string("\nok   ") + finding), std::string::npos) << check;
  }
}

// What a branch's run was before is in its log: it can be checked, and be branched off again.
TEST_F(ResumeTest, ABranchOfABranchComesAgain) {
  ASSERT_EQ(run_program(short_run + "--out a.h5").code, 0);
  ASSERT_EQ(run_program("branch a.h5 --time 0.1 --set model.bending_stiffness=1000 --set "
                        "time.step=0.0025 --out b.h5 --quiet")
                .code,
            0);
  ASSERT_EQ(run_program("branch b.h5 --time 0.3 --set model.bending_stiffness=500 --out c.h5 "
                        "--quiet")
                .code,
            0);
  const std::string check = run_program("check c.h5").output;
  EXPECT_NE(check.find("comes again to the end, bit by bit"), std::string::npos) << check;
  rewrite<double>(folder / "c.h5", "/branch/end", H5::PredType::NATIVE_DOUBLE,
                  [](std::vector<double>& ends) { ends.back() += 20; });
  const std::string other = run_program("check c.h5").output;
  EXPECT_NE(other.find("does not begin where its run does"), std::string::npos) << other;
}

TEST_F(ResumeTest, ABranchFromAnotherStateThanTheLogHasSaysSo) {
  ASSERT_EQ(run_program(short_run + "--out a.h5").code, 0);
  const std::string word = "comes there otherwise";
  const auto branch = [this](const std::string& out) {
    return run_program("branch a.h5 --time 0.2 --quiet --out " + out).output;
  };
  EXPECT_EQ(branch("b.h5").find(word), std::string::npos);
  rewrite<double>(folder / "a.h5", "/trajectory/q", H5::PredType::NATIVE_DOUBLE,
                  [](std::vector<double>& q) { q[q.size() / 21 * 10 + 20] += 1e-6; });
  EXPECT_NE(branch("c.h5").find(word), std::string::npos);
}

}  // namespace hagfish::resume_command_test
