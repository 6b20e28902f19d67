// `hagfish picture` from outside.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "tests/support/program_runs.hpp"

namespace hagfish::picture_command_test {

namespace fs = std::filesystem;

TEST_F(ProgramTest, PictureDrawsTheFramesAsked) {
  // Frames at 0, 0.02 and 0.04 s, and the end.
  ASSERT_EQ(run_program("run --quiet --set time.duration=0.05 --out a.h5").code, 0);
  const ProgramOutcome one = run_program("picture a.h5 --out one.png");
  EXPECT_EQ(one.code, 0) << one.output;
  EXPECT_NE(one.output.find("file\ttime_s\tleft_cm\tbottom_cm\tcm_per_pixel\none.png\t0.05\t"),
            std::string::npos)
      << one.output;
  EXPECT_GT(fs::file_size(folder / "one.png"), 0u);
  const ProgramOutcome two = run_program("picture a.h5 --out two.png --time 0.001 --time 0.019");
  EXPECT_EQ(two.code, 0) << two.output;
  EXPECT_NE(two.output.find("\ntwo_1.png\t0\t"), std::string::npos) << two.output;
  EXPECT_NE(two.output.find("\ntwo_2.png\t0.02\t"), std::string::npos) << two.output;
  EXPECT_TRUE(fs::exists(folder / "two_1.png") && fs::exists(folder / "two_2.png"));
}

/// Width and height of a PNG, which its header has in 8 bytes from byte 16 on.
std::pair<int, int> size_of(const fs::path& png) {
  std::ifstream file(png, std::ios::binary);
  std::array<unsigned char, 24> head{};
  file.read(static_cast<char*>(static_cast<void*>(head.data())), head.size());
  const auto number = [&head](int at) {
    return (head[at] << 24) | (head[at + 1] << 16) | (head[at + 2] << 8) | head[at + 3];
  };
  return {number(16), number(20)};
}

TEST_F(ProgramTest, PicturesOfASizeAreFramesOfAFilm) {
  ASSERT_EQ(run_program("run --quiet --set time.duration=0.25 --out a.h5").code, 0);
  std::string times;
  for (int k = 0; k < 11; ++k) times += " --time " + std::to_string(0.02 * k);
  const ProgramOutcome made =
      run_program("picture a.h5 --out f.png --size 320x180 --colour curvature" + times);
  EXPECT_EQ(made.code, 0) << made.output;
  for (const char* name : {"f_01.png", "f_02.png", "f_11.png"}) {
    EXPECT_EQ(size_of(folder / name), std::pair(320, 180)) << name;
  }
  // One window: the last three fields of each line, the corner and the scale, are the same.
  std::istringstream lines(made.output);
  std::set<std::string> windows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line))
    windows.insert(line.substr(line.find('\t', line.find('\t') + 1)));
  EXPECT_EQ(windows.size(), 1u) << made.output;
}

TEST_F(ProgramTest, PictureRefusesBadInputInOneLine) {
  ASSERT_EQ(run_program(brief_run + "--out a.h5").code, 0);
  fs::rename(folder / "a.h5", folder / "a.log");  // expect_refused looks for logs left behind
  expect_refused("picture a.log --out a.png --time 0.5", {"a.log", "--time 0.5", "0 to 0.02 s"});
  expect_refused("picture a.log --out a.png --time -1", {"a.log", "--time -1"});
  expect_refused("picture a.log --out a.png --time nan", {"a.log", "--time nan"});
  expect_refused("picture a.log --out a.png --pitch inf", {"--pitch", "inf"});
  expect_refused("picture a.log --out a.png --yaw 1e308", {"--yaw", "1e+308"});
  for (const char* size :
       {"1280", "1280x", "x720", "1280x720x1", "15x720", "1280x9000", "-20x20"}) {
    expect_refused("picture a.log --out a.png --size " + std::string(size), {"--size", "px"});
  }
  expect_refused("picture a.log --out a.png --colour hue", {"--colour", "hue", "curvature"});
  expect_refused("picture a.log --out a.jpg", {"a.jpg", "--out", ".png"});
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

}  // namespace hagfish::picture_command_test
