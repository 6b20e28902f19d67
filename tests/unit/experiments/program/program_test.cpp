// The program from outside: exit codes, one clear line for bad input, nothing half-written.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/run/controller.hpp"
#include "experiments/audit/log_contents.hpp"
#include "tests/support/foreign_qps.hpp"

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string output;  ///< standard output and error
};

class ProgramTest : public testing::Test {
 protected:
  ProgramTest()
      : folder(fs::path(testing::TempDir()) / ("hagfish_program_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
  }
  ~ProgramTest() override { fs::remove_all(folder); }

  Outcome hagfish(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + folder.string() + "' && " + before + " '" +
                                HAGFISH_PROGRAM + "' " + arguments + " 2>&1";
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
      outcome.output.append(buffer.data(), n);
    }
    outcome.code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }

  /// Bad input: exit 2, one line that holds every part, and no file left.
  void expect_refused(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Outcome outcome = hagfish(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << " in " << outcome.output;
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
      EXPECT_NE(entry.path().extension(), ".h5") << entry.path();
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }

  fs::path folder;
};

// 0.02 s of the run: as good as any where only the program's manners are tested.
const std::string brief = "run --quiet --set time.duration=0.02 ";

TEST_F(ProgramTest, RunsInfoAndCheck) {
  EXPECT_EQ(hagfish(brief + "--out a.h5").code, 0);
  const Outcome info = hagfish("info a.h5");
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.output.find("status           complete"), std::string::npos) << info.output;
  // Too short to tie: the audit must say what is missing and fail.
  const Outcome check = hagfish("check a.h5");
  EXPECT_EQ(check.code, 1);
  EXPECT_NE(check.output.find("check failed: knot held"), std::string::npos) << check.output;
  EXPECT_NE(check.output.find("ok   force balance"), std::string::npos) << check.output;
}

TEST_F(ProgramTest, PictureDrawsTheFramesAsked) {
  // Frames at 0, 0.02 and 0.04 s.
  ASSERT_EQ(hagfish("run --quiet --set time.duration=0.05 --out a.h5").code, 0);
  const Outcome one = hagfish("picture a.h5 --out one.png");
  EXPECT_EQ(one.code, 0) << one.output;
  EXPECT_NE(one.output.find("file\ttime_s\tleft_cm\tbottom_cm\tcm_per_pixel\none.png\t0.04\t"),
            std::string::npos)
      << one.output;
  EXPECT_GT(fs::file_size(folder / "one.png"), 0u);
  const Outcome two = hagfish("picture a.h5 --out two.png --time 0.001 --time 0.019");
  EXPECT_EQ(two.code, 0) << two.output;
  EXPECT_NE(two.output.find("\ntwo_1.png\t0\t"), std::string::npos) << two.output;
  EXPECT_NE(two.output.find("\ntwo_2.png\t0.02\t"), std::string::npos) << two.output;
  EXPECT_TRUE(fs::exists(folder / "two_1.png") && fs::exists(folder / "two_2.png"));
}

TEST_F(ProgramTest, PictureRefusesBadInputInOneLine) {
  ASSERT_EQ(hagfish(brief + "--out a.h5").code, 0);
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
  expect_refused("picture a.log --out folder.png", {"folder.png", "directory"});
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

// Ten steps, with joints that can hardly twist, so that limits are in reach from the first.
const std::string record =
    "record-qp --quiet --set specimen.twist_limit_deg=0.01 --set time.step=0.005 --set "
    "time.duration=0.05 --out ";

TEST_F(ProgramTest, RecordsQpsAndMeasuresBackEnds) {
  const Outcome recorded = hagfish(record + "a.qps");
  EXPECT_EQ(recorded.code, 0);
  EXPECT_EQ(recorded.output, "a.qps: 10 QPs of 10 steps\n");
  const Outcome measured = hagfish("qp a.qps --repeat 1 --csv a.csv");
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
  const Outcome chosen =
      hagfish("qp a.qps --backend ipopt-unpolished --tolerance 1e-4 --tolerance 1e-7 --repeat 1");
  EXPECT_EQ(chosen.code, 0) << chosen.output;
  EXPECT_NE(chosen.output.find("\nipopt-unpolished 1e-07   cold "), std::string::npos)
      << chosen.output;
  EXPECT_EQ(chosen.output.find("active-set"), std::string::npos) << chosen.output;
}

TEST_F(ProgramTest, RecordsPrimalQpsNowAndThen) {
  EXPECT_EQ(hagfish(record + "a.qps --primal --every 4").output, "a.qps: 3 QPs of 10 steps\n");
  const Outcome measured = hagfish("qp a.qps --backend active-set --repeat 1");
  EXPECT_EQ(measured.code, 0) << measured.output;
  EXPECT_NE(measured.output.find("3 QPs (3 primal) in 3 sequences"), std::string::npos)
      << measured.output;
}

TEST_F(ProgramTest, AFailedRunKeepsItsQps) {
  const Outcome run = hagfish(
      "record-qp --quiet --set specimen.twist_limit_deg=0.01 --set guard.speed=5 --out a.qps");
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_NE(run.output.find("a.qps: the run failed: body"), std::string::npos) << run.output;
  EXPECT_EQ(hagfish("qp a.qps --backend active-set --repeat 1").code, 0);
}

TEST_F(ProgramTest, InfeasibleQpsFail) {
  {
    hagfish::ForeignQps set(folder / "a.qps");
    for (int i = 0; i < 20; ++i) {
      set.problem(std::to_string(i));
      i == 1 ? put_primal(set) : put_contradiction(set);
    }
  }
  const Outcome measured = hagfish("qp a.qps --backend active-set --backend ipopt --repeat 1");
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
    hagfish::ForeignQps set(folder / "bad.qps");
    set.problem("7");
    put_primal(set);
    set.replace("d", {1, 2, 3});
  }
  expect_refused("qp bad.qps", {"bad.qps", "/qp/7", "C is 2 x 2, not 3 x 2"});
  expect_refused("qp missing.qps", {"missing.qps", "no such file"});
  std::ofstream(folder / "text.qps") << "no HDF5";
  expect_refused("qp text.qps", {"text.qps"});
  expect_refused("qp bad.qps --backend none", {"--backend", "none"});
  expect_refused("qp bad.qps --tolerance 0", {"--tolerance"});
  expect_refused("qp bad.qps --repeat 0", {"--repeat"});
  expect_refused("qp", {"SET"});
  expect_refused("record-qp", {"--out"});
  expect_refused(record + "b.h5 --every 0", {"--every"});
  expect_refused(record + "b.h5 --qp none", {"--qp", "active-set"});
  expect_refused(record + "bad.qps", {"bad.qps", "--force"});
  expect_refused(record + ". --force", {"not a regular file"});
  expect_refused(record + "/no/such/folder/b.h5", {"/no/such/folder/b.h5", "No such file"});
  EXPECT_EQ(hagfish(record + "bad.qps --force").code, 0);
  EXPECT_EQ(hagfish("qp bad.qps --backend active-set --repeat 1").code, 0);
  expect_refused("qp bad.qps --backend active-set --repeat 1 --csv /no/such/folder/a.csv",
                 {"/no/such/folder/a.csv"});
}

TEST_F(ProgramTest, WritesMjcf) {
  const std::string write = "mjcf --set model.bodies=100 --out model ";
  EXPECT_EQ(hagfish(write).code, 0);
  EXPECT_TRUE(fs::exists(folder / "model/hagfish.xml"));
  EXPECT_TRUE(fs::exists(folder / "model/hagfish_bodies_80.xml"));
  expect_refused(write, {"model/hagfish.xml", "--force"});
  EXPECT_EQ(hagfish(write + "--force --clamp").code, 0);
  expect_refused("mjcf nosuch --out model", {"nosuch"});
  std::ofstream(folder / "file") << "in the way";
  expect_refused("mjcf --out file/model", {"file/model"});
}

TEST_F(ProgramTest, ComparesWithMujoco) {
  const Outcome compare = hagfish("compare --set model.bodies=3 --out compare.h5");
  EXPECT_EQ(compare.code, 0) << compare.output;
  EXPECT_NE(compare.output.find("acceleration"), std::string::npos) << compare.output;
  EXPECT_EQ(compare.output.find("FAIL"), std::string::npos) << compare.output;
  EXPECT_TRUE(fs::exists(folder / "compare.h5"));
  fs::remove(folder / "compare.h5");
  expect_refused("compare --set model.bodies=1", {"model.bodies"});
}

TEST_F(ProgramTest, APresetComesBeforeSetAndQp) {
  const auto written = [this](const std::string& arguments) {
    const Outcome run = hagfish(brief + "--force --out a.h5 " + arguments);
    EXPECT_EQ(run.code, 0) << arguments << ": " << run.output;
    const hagfish::LogContents log((folder / "a.h5").string());
    return std::pair(log.resolved.scene.time.step, log.h5.root_text("qp"));
  };
  EXPECT_EQ(written(""), std::pair(0.002, std::string("ipopt")));
  EXPECT_EQ(written("--preset default"), std::pair(0.002, std::string("active-set")));
  EXPECT_EQ(written("--preset quick"), std::pair(0.02, std::string("active-set")));
  EXPECT_EQ(written("--preset quick --set time.step=0.01").first, 0.01);
  EXPECT_EQ(written("--preset quick --qp ipopt").second, "ipopt");
}

TEST_F(ProgramTest, IntegratesSmoothMotions) {
  const Outcome whip = hagfish("integrate --set model.bodies=3 --motion whip --out whip.h5");
  EXPECT_EQ(whip.code, 0) << whip.output;
  EXPECT_NE(whip.output.find("MuJoCo RK4"), std::string::npos) << whip.output;
  EXPECT_TRUE(fs::exists(folder / "whip.h5"));
  fs::remove(folder / "whip.h5");
  expect_refused("integrate --motion jump --out i.h5", {"--motion jump", "coil hanging whip"});
  expect_refused("integrate", {"--out"});
}

TEST_F(ProgramTest, PlaybackRefusesALogWithoutASlide) {
  EXPECT_EQ(hagfish(brief + "--out a.log").code, 0);
  expect_refused("playback a.log --out p.h5", {"a.log", "does not slide"});
  expect_refused("playback none.log --out p.h5", {"none.log", "no such file"});
}

TEST_F(ProgramTest, PlaybackRefusesRestartsBetweenFrames) {
  const Outcome run = hagfish(
      "run table1 --preset quick --set time.step=0.01 --set time.frame_interval=0.03 --until slide "
      "--quiet --out a.log");
  ASSERT_EQ(run.code, 0) << run.output;
  expect_refused("playback a.log --out p.h5", {"a.log", "0.04 s", "0.03 s", "time.frame_interval"});
}

TEST_F(ProgramTest, PlaybackRefusesALogWithoutMeans) {
  const Outcome run = hagfish("run table1 --preset quick --until slide --quiet --out a.log");
  ASSERT_EQ(run.code, 0) << run.output;
  H5::H5File((folder / "a.log").string(), H5F_ACC_RDWR).unlink("/mean/forces/thigmotaxis");
  expect_refused("playback a.log --out p.h5", {"a.log", "/mean/forces/thigmotaxis"});
}

/// Of a log whose means are all 0 but for one that ends where the slide begins, nothing drives the
/// slide: not that mean, which is of the time before, and no single step's force.
TEST_F(ProgramTest, PlaybackAppliesTheMeansBetweenFramesAlone) {
  const Outcome run = hagfish(
      "run table1 --preset quick --set controller.release_at=9 --until slide --quiet --out a.log");
  ASSERT_EQ(run.code, 0) << run.output;
  const auto paths = [this] {
    const Outcome played = hagfish("playback a.log --out p.log");
    EXPECT_EQ(played.code, 0) << played.output;
    const hagfish::Hdf5Reader h5(folder / "p.log");
    return std::pair(h5.doubles("/thigmotaxis_0.04s/drift"), h5.doubles("/none_0.04s/drift"));
  };
  const auto [driven, none] = paths();
  ASSERT_GT(driven.size(), 10);
  EXPECT_NE(driven, none);
  hagfish::Hdf5Reader::Rows means;
  {
    const hagfish::LogContents log((folder / "a.log").string());
    const auto begin = std::find(log.phase.begin(), log.phase.end(),
                                 static_cast<std::int64_t>(hagfish::Phase::slide));
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

TEST_F(ProgramTest, ListsTheScenes) {
  const Outcome scenes = hagfish("scenes");
  EXPECT_EQ(scenes.code, 0);
  EXPECT_NE(scenes.output.find("table1"), std::string::npos);
  EXPECT_NE(scenes.output.find("overhand_waypoints"), std::string::npos);
}

TEST_F(ProgramTest, RunsEveryBodyCount) {
  for (const char* bodies : {"2", "3", "25", "400"}) {
    const Outcome run = hagfish(brief + "--force --out n.h5 --set model.bodies=" + bodies);
    EXPECT_EQ(run.code, 0) << bodies << ": " << run.output;
  }
}

TEST_F(ProgramTest, RefusesBadInputInOneLine) {
  expect_refused("run --set model.bodie=100", {"model.bodie", "unknown", "bodies"});
  expect_refused("run --set model.bodies=401", {"model.bodies", "401", "400"});
  expect_refused("run --set model.bodies=many", {"model.bodies", "whole number"});
  expect_refused("run --set time.step=nan", {"time.step", "finite"});
  expect_refused("run --set time.step=0", {"time.step", "positive"});
  expect_refused("run --set specimen.length=-1", {"specimen.length", "positive"});
  expect_refused("run --set time.frame_interval=0.003", {"time.frame_interval", "whole number"});
  expect_refused("run --set expect.knot=unknot", {"expect.knot", "3_1"});
  expect_refused("run --set controller.contact_gap=1", {"controller.contact_gap", "margin"});
  expect_refused("run --out . --force", {"not a regular file"});
  expect_refused("run --qp none", {"--qp", "ipopt"});
  expect_refused("run --preset best", {"--preset best", "quick, default, figure"});
  expect_refused("run --no-such-option", {"--no-such-option"});
  expect_refused("run specimens/pacific_hagfish", {"scenes"});
  expect_refused("run nowhere", {"nowhere", "scenes"});
  expect_refused("run missing.toml", {"missing.toml"});
  expect_refused("run --out /no/such/folder/x.h5", {"/no/such/folder/x.h5", "No such file"});
  expect_refused("info missing.h5", {"missing.h5", "no such file"});
  fs::create_directory(folder / "folder.toml");
  expect_refused("run folder.toml", {"folder.toml"});
}

TEST_F(ProgramTest, KeepsAnExistingLogUnlessForced) {
  std::ofstream(folder / "a.h5") << "precious";
  const Outcome kept = hagfish(brief + "--out a.h5");
  EXPECT_EQ(kept.code, 2);
  EXPECT_NE(kept.output.find("a.h5: already exists (--force replaces it)"), std::string::npos);
  EXPECT_EQ(fs::file_size(folder / "a.h5"), 8u);
  EXPECT_EQ(hagfish(brief + "--out a.h5 --force").code, 0);
  EXPECT_GT(fs::file_size(folder / "a.h5"), 8u);
}

TEST_F(ProgramTest, FullDiskIsOneLine) {
  // A limit on file size (blocks of 1024 bytes) with its signal ignored stands for a full disk.
  const Outcome full =
      hagfish("run --quiet --set time.duration=2 --out a.h5", "trap '' XFSZ && ulimit -f 150 &&");
  EXPECT_EQ(full.code, 2) << full.output;
  EXPECT_EQ(std::count(full.output.begin(), full.output.end(), '\n'), 1) << full.output;
  EXPECT_NE(full.output.find("a.h5"), std::string::npos) << full.output;
  EXPECT_NE(full.output.find("File too large"), std::string::npos) << full.output;
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(ProgramTest, AFailedStepLeavesAReadableLogWithTheCause) {
  // Joints of a body pulled this hard move faster than the guard allows.
  const Outcome run = hagfish("run --quiet --set guard.speed=5 --out a.h5");
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_NE(run.output.find("failed: body"), std::string::npos) << run.output;
  const Outcome info = hagfish("info a.h5");
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.output.find("failed: body"), std::string::npos) << info.output;
  EXPECT_NE(info.output.find("at step"), std::string::npos) << info.output;
  EXPECT_EQ(hagfish("check a.h5").code, 1);
}

/// A script that ends after a second, long before anything is tied.
const std::string hasty =
    "run --qp active-set --set script.kind=position --set script.spring=3000 --set "
    "script.largest_force=500 --set script.unit=L --set "
    "'script.knots=[[0, 0.995, 0, 0], [1, 0.95, 0.05, 0]]' --set time.step=0.02 ";

TEST_F(ProgramTest, AScriptThatTiesNothingEndsWithCode3AndSaysSo) {
  const Outcome run = hagfish(hasty + "--quiet --out a.h5");
  EXPECT_EQ(run.code, 3) << run.output;
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  EXPECT_NE(
      run.output.find("a.h5: failed: the script ended with no knot, and tied none before, but "
                      "expect.knot = 3_1"),
      std::string::npos)
      << run.output;
  EXPECT_EQ(hagfish("check a.h5").code, 1);
  const Outcome none = hagfish(hasty +
                               "--quiet --force --out a.h5 --set expect.knot= --set "
                               "time.duration=3.5");
  EXPECT_EQ(none.code, 0) << none.output;
}

TEST_F(ProgramTest, AScriptThatTiesAnotherKnotEndsWithCode3AndNamesIt) {
  const Outcome run = hagfish("run --preset quick --quiet --set expect.knot=4_1 --out a.h5");
  EXPECT_EQ(run.code, 3) << run.output;
  EXPECT_NE(run.output.find("failed: the script ended with a 3_1, tied since "), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find(", but expect.knot = 4_1 at step "), std::string::npos) << run.output;
}

TEST_F(ProgramTest, StopsWhenAPhaseHasEndedAndTellsTheKnotAsItGoes) {
  const Outcome run = hagfish("run --preset quick --until form --out a.log");
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_NE(run.output.find(" s  knot 3_1  "), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("tighten  t = "), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("slide    t = "), std::string::npos) << run.output;
  {
    const hagfish::LogContents log((folder / "a.log").string());
    EXPECT_EQ(log.resolved.scene.time.until, hagfish::Phase::form);  // a rerun stops there too
    EXPECT_GT(log.time.back(), 9);
  }
  // What was not reached is not judged.
  const Outcome check = hagfish("check a.log");
  EXPECT_EQ(check.code, 0) << check.output;
  EXPECT_EQ(check.output.find("slide"), std::string::npos) << check.output;
  expect_refused("run --until tied --out b.h5", {"time.until=tied", "must be one of", "tighten"});
}

TEST_F(ProgramTest, AbsurdNumbersFailTheRunAndDoNotCrashIt) {
  for (const char* absurd : {"specimen.length=1e200", "specimen.mass=1e300", "time.step=1e-300"}) {
    const Outcome run = hagfish(std::string("run --quiet --force --out a.h5 --set ") + absurd);
    EXPECT_TRUE(run.code >= 1 && run.code <= 3) << absurd << ": " << run.code << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  }
}

}  // namespace
