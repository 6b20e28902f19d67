// `hagfish picture` from outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/program_runs.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

TEST_F(ProgramTest, PictureDrawsTheFramesAsked) {
  // Frames at 0, 0.02 and 0.04 s.
  ASSERT_EQ(run_program("run --quiet --set time.duration=0.05 --out a.h5").code, 0);
  const ProgramOutcome one = run_program("picture a.h5 --out one.png");
  EXPECT_EQ(one.code, 0) << one.output;
  EXPECT_NE(one.output.find("file\ttime_s\tleft_cm\tbottom_cm\tcm_per_pixel\none.png\t0.04\t"),
            std::string::npos)
      << one.output;
  EXPECT_GT(fs::file_size(folder / "one.png"), 0u);
  const ProgramOutcome two = run_program("picture a.h5 --out two.png --time 0.001 --time 0.019");
  EXPECT_EQ(two.code, 0) << two.output;
  EXPECT_NE(two.output.find("\ntwo_1.png\t0\t"), std::string::npos) << two.output;
  EXPECT_NE(two.output.find("\ntwo_2.png\t0.02\t"), std::string::npos) << two.output;
  EXPECT_TRUE(fs::exists(folder / "two_1.png") && fs::exists(folder / "two_2.png"));
}

TEST_F(ProgramTest, PictureRefusesBadInputInOneLine) {
  ASSERT_EQ(run_program(brief_run + "--out a.h5").code, 0);
  fs::rename(folder / "a.h5", folder / "a.log");  // expect_refused looks for logs left behind
  expect_refused("picture missing.log --out a.png", {"missing.log", "no such file"});
  expect_refused("picture a.log --out a.png --time 0.5", {"a.log", "--time 0.5", "0 to 0 s"});
  expect_refused("picture a.log --out a.png --time -1", {"a.log", "--time -1"});
  expect_refused("picture a.log --out a.png --time nan", {"a.log", "--time nan"});
  expect_refused("picture a.log --out a.png --pitch inf", {"--pitch", "inf"});
  expect_refused("picture a.log --out a.jpg", {"a.jpg", "--out", ".png"});
  expect_refused("picture a.log", {"--out"});
  expect_refused("picture a.log --out /no/such/folder/a.png", {"/no/such/folder/a.png", "No such"});
  fs::create_directory(folder / "folder.png");
  expect_refused("picture a.log --out folder.png", {"folder.png", "not a regular file"});
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

}  // namespace
}  // namespace hagfish
