// `hagfish movie` from outside.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/program_runs.hpp"

namespace hagfish::movie_command_test {

namespace fs = std::filesystem;

class MovieTest : public ProgramTest {
 protected:
  void SetUp() override {
    if (std::system("command -v ffprobe >/dev/null") != 0) GTEST_SKIP() << "no ffmpeg here";
    // Frames from 0 to 1 s, as the last step begins there.
    ASSERT_EQ(run_program("run --preset quick --quiet --set time.duration=1.03 --out a.h5").code,
              0);
    fs::rename(folder / "a.h5", folder / "a.log");  // expect_refused looks for logs left behind
  }

  /// Width, height, pictures.
  std::string probe(const std::string& film) const {
    return run_shell(
               "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
               "stream=width,height,nb_read_frames -of csv=p=0 " +
               film)
        .output;
  }
};

TEST_F(MovieTest, HasAPictureForEachMomentOfItsSize) {
  const ProgramOutcome film = run_program("movie a.log --out a.mp4 --size 320x180");
  EXPECT_EQ(film.code, 0) << film.output;
  EXPECT_EQ(film.output, "a.mp4: 26 pictures, 1.0 s\n");
  EXPECT_EQ(probe("a.mp4"), "320,180,26\n");
  EXPECT_EQ(run_program("movie a.log --out b.mp4 --size 320x180 --speed 0.5 --colour contact").code,
            0);
  EXPECT_EQ(probe("b.mp4"), "320,180,52\n");
  EXPECT_EQ(run_program("movie a.log --out c.gif --size 161x91 --speed 2").code, 0);
  EXPECT_EQ(probe("c.gif"), "161,91,7\n");
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    EXPECT_TRUE(entry.path().extension() == ".mp4" || entry.path().extension() == ".gif" ||
                entry.path().extension() == ".log")
        << entry.path() << " left behind";
  }
}

TEST_F(MovieTest, RefusesBadInputInOneLine) {
  expect_refused("movie a.log --out a.avi", {"a.avi", ".mp4 or .gif"});
  expect_refused("movie a.log --out a.mp4 --size 321x180", {"--size 321x180", "even"});
  expect_refused("movie a.log --out a.mp4 --size big", {"--size big"});
  expect_refused("movie a.log --out a.mp4 --speed 0", {"--speed"});
  expect_refused("movie a.log --out a.mp4 --speed nan", {"--speed", "nan"});
  expect_refused("movie a.log --out a.mp4 --speed 1e-9", {"--speed", "pictures"});
  EXPECT_FALSE(fs::exists(folder / "a.mp4"));
}

}  // namespace hagfish::movie_command_test
