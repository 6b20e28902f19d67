// `hagfish playback` from outside.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/log/reading/log_contents.hpp"
#include "core/scene/phase.hpp"
#include "tests/support/program_runs.hpp"

namespace hagfish::playback_command_test {

TEST_F(ProgramTest, PlaybackRefusesALogWithoutASlide) {
  EXPECT_EQ(run_program(brief_run + "--out a.log").code, 0);
  expect_refused("playback a.log --out p.h5", {"a.log", "has no slide of the knot"});
}

TEST_F(ProgramTest, PlaybackRefusesRestartsBetweenFrames) {
  const ProgramOutcome run = run_program(
      "run table1 --preset quick --set time.step=0.01 --set time.frame_interval=0.03 --until slide "
      "--quiet --out a.log");
  ASSERT_EQ(run.code, 0) << run.output;
  expect_refused("playback a.log --out p.h5", {"a.log", "0.04 s", "0.03 s", "time.frame_interval"});
}

/// Of a log whose means are all 0 but for one that ends where the slide begins, nothing drives the
/// slide: not that mean, which is of the time before, and no single step's force.
TEST_F(ProgramTest, PlaybackAppliesTheMeansBetweenFramesAlone) {
  const ProgramOutcome run = run_program(
      "run table1 --preset quick --set controller.release_at=9 --until slide --quiet --out a.log");
  ASSERT_EQ(run.code, 0) << run.output;
  const auto paths = [this] {
    const ProgramOutcome played = run_program("playback a.log --out p.log --force");
    EXPECT_EQ(played.code, 0) << played.output;
    const Hdf5Reader h5(folder / "p.log");
    for (const std::string group : {"", "/thigmotaxis_0.04s"}) {
      EXPECT_LT(std::ranges::max(h5.doubles(group + "/head_end")),
                std::ranges::min(h5.doubles(group + "/tail_end")));
    }
    return std::pair(h5.doubles("/thigmotaxis_0.04s/drift"), h5.doubles("/none_0.04s/drift"));
  };
  const auto [driven, none] = paths();
  ASSERT_GT(driven.size(), 10);
  EXPECT_NE(driven, none);
  Hdf5Reader::Rows means;
  {
    const LogContents log((folder / "a.log").string());
    const auto begin =
        std::find(log.phase.begin(), log.phase.end(), static_cast<std::int64_t>(Phase::slide));
    means.setZero(log.qdot.rows(), log.qdot.cols());
    means.row(begin - log.phase.begin()).setConstant(1e3);
  }
  H5::H5File((folder / "a.log").string(), H5F_ACC_RDWR)
      .openDataSet("/mean/forces/thigmotaxis")
      .write(means.data(), H5::PredType::NATIVE_DOUBLE);
  const auto [zeroed, control] = paths();
  EXPECT_EQ(zeroed, control);
  EXPECT_EQ(control, none);
}

}  // namespace hagfish::playback_command_test
