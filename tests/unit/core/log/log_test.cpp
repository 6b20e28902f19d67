// The log against its contract: every dataset with its shape, unit and description; nothing
// half-written under the final name; a full disk or an existing file in one line.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/log_writer.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::log_test {

namespace fs = std::filesystem;

/// A short run's log.
class LogTest : public testing::Test {
 protected:
  LogTest() {
    scene.time.frame_interval = 0.01;
    scene.script.kind = ScriptSettings::Kind::force;
    scene.script.waypoints = {{0, {100, 200, 0}}, {1, {100, 200, 0}}};
    header.command = "test";
    header.qp = "ipopt";
    header.scene = scene_to_toml(scene, table1_specimen());
    header.mjcf = {{"hagfish.xml", "<mujoco/>"}};
  }

  /// Steps and logs, each step in `wall_time` (s); returns the records' states.
  std::vector<State> write(LogWriter& log, int steps, double wall_time = 0) {
    std::vector<State> states;
    for (int k = 0; k < steps; ++k) {
      const StepRecord record = take_step(model, scene, sim);
      states.push_back(record.after.state);
      log.write(record, sim, wall_time * (k + 1));
    }
    return states;
  }

  TemporaryFolder folder;
  Scene scene = table1_scene(10);
  Model model = table1_hagfish(10);
  LogHeader header;
  Simulation sim = start(model, scene, "ipopt");
};

struct Dataset {
  std::string path;
  std::vector<hsize_t> shape;
  std::string unit;
};

/// What a log of `t` frames of `n` bodies must hold.
std::vector<Dataset> contract(hsize_t t, hsize_t n, hsize_t nq, hsize_t nv) {
  return {{"/model/mass", {n}, "g"},
          {"/model/length", {n}, "cm"},
          {"/model/radius", {n}, "cm"},
          {"/model/limit_lower", {nv}, "rad"},
          {"/model/limit_upper", {nv}, "rad"},
          {"/model/bending_limit", {n}, "rad"},
          {"/trajectory/step", {t}, "1"},
          {"/trajectory/time", {t}, "s"},
          {"/trajectory/phase", {t}, "1"},
          {"/trajectory/q", {t, nq}, "mixed: cm, 1, rad"},
          {"/trajectory/qdot", {t, nv}, "cm/s, rad/s"},
          {"/trajectory/position", {t, n, 3}, "cm"},
          {"/forces/thigmotaxis", {t, nv}, "dyn, dyn·cm"},
          {"/forces/contact", {t, nv}, "dyn, dyn·cm"},
          {"/forces/limit", {t, nv}, "dyn, dyn·cm"},
          {"/forces/head", {t, nv}, "dyn, dyn·cm"},
          {"/forces/wall", {t, nv}, "dyn, dyn·cm"},
          {"/forces/tip", {t, 3}, "dyn"},
          {"/thigmotaxis/body_a", {t, 2}, "1"},
          {"/thigmotaxis/body_b", {t, 2}, "1"},
          {"/thigmotaxis/lambda", {t, 4}, "dyn"},
          {"/thigmotaxis/speed", {t, 4}, "cm/s"},
          {"/thigmotaxis/slack", {t, 4}, "cm/s"},
          {"/knot/determinant", {t}, "1"},
          {"/knot/v2", {t}, "1"},
          {"/knot/agreement", {t}, "1"},
          {"/knot/head_end", {t}, "cm"},
          {"/knot/tail_end", {t}, "cm"},
          {"/diagnostics/solve", {t}, "1"},
          {"/diagnostics/rows", {t}, "1"},
          {"/diagnostics/active", {t}, "1"},
          {"/diagnostics/contacts", {t}, "1"},
          {"/diagnostics/iterations", {t}, "1"},
          {"/diagnostics/kkt_stationarity", {t}, "1"},
          {"/diagnostics/kkt_primal", {t}, "1"},
          {"/diagnostics/kkt_complementarity", {t}, "1"},
          {"/diagnostics/penetration", {t}, "cm"},
          {"/diagnostics/skin_fold", {t}, "1"},
          {"/diagnostics/limit_violation", {t}, "rad"},
          {"/diagnostics/head_drift", {t}, "cm"},
          {"/diagnostics/kinetic_energy", {t}, "erg"},
          {"/diagnostics/work_thigmotaxis", {t}, "erg"},
          {"/diagnostics/work_tip", {t}, "erg"},
          {"/diagnostics/dissipated", {t}, "erg"},
          {"/diagnostics/wall_time", {t}, "s"}};
}

TEST_F(LogTest, HoldsWhatTheContractNames) {
  const fs::path file = folder / "run.h5";
  LogWriter log(file, false, header, model, scene);
  write(log, 12);
  log.finish("complete", sim);
  const Hdf5Reader h5(file);
  const hsize_t t = 4;  // steps 0, 5 and 10 of 12 at one frame in 5, and the end
  const hsize_t n = 10;
  const hsize_t nq = model.nq();
  const hsize_t nv = model.nv();
  for (const auto& [path, shape, unit] : contract(t, n, nq, nv)) {
    ASSERT_TRUE(h5.has(path)) << path;
    EXPECT_EQ(h5.shape(path), shape) << path;
    EXPECT_EQ(h5.attribute(path, "unit"), unit) << path;
    EXPECT_FALSE(h5.attribute(path, "description").empty()) << path;
  }
  EXPECT_EQ(h5.texts("/model/joint_name").size(), n);
  EXPECT_EQ(h5.texts("/model/dof_name").size(), nv);
  EXPECT_EQ(h5.texts("/model/joint_name")[1], "j01_bend");
  EXPECT_EQ(h5.texts("/mjcf/hagfish.xml"), std::vector<std::string>{"<mujoco/>"});
  for (const char* name : {"creator", "creator_version", "git_revision", "created", "command",
                           "scene", "compiler", "cpu"}) {
    EXPECT_FALSE(h5.root_text(name).empty()) << name;
  }
  EXPECT_EQ(h5.root_text("format"), "hagfish-log");
  EXPECT_EQ(h5.root_int("format_version"), 1);
  EXPECT_EQ(h5.root_text("status"), "complete");
  EXPECT_EQ(h5.shape("/steps/kkt"), std::vector<hsize_t>{12});
}

TEST_F(LogTest, ReadsBackTheVeryStatesThatWereWritten) {
  const fs::path file = folder / "run.h5";
  LogWriter log(file, false, header, model, scene);
  const std::vector<State> states = write(log, 11);
  log.finish("complete", sim);
  const Hdf5Reader h5(file);
  const Hdf5Reader::Rows q = h5.rows("/trajectory/q");
  const Hdf5Reader::Rows qdot = h5.rows("/trajectory/qdot");
  EXPECT_EQ(h5.integers("/trajectory/step"), (std::vector<std::int64_t>{0, 5, 10, 11}));
  for (const int frame : {0, 1, 2}) {
    EXPECT_EQ(q.row(frame).transpose(), states[5 * frame].q);
    EXPECT_EQ(qdot.row(frame).transpose(), states[5 * frame].qdot);
  }
  EXPECT_EQ(q.row(3).transpose(), sim.now.state.q);
  EXPECT_EQ(qdot.row(3).transpose(), sim.now.state.qdot);
  // The scene in the log makes the run again.
  const ResolvedScene again = read_scene_text(h5.root_text("scene"), "log");
  EXPECT_EQ(again.scene.time.step, scene.time.step);
  EXPECT_EQ(again.specimen.mass, table1_specimen().mass);
}

TEST_F(LogTest, KeepsWhatWasSavedUnlessFinished) {
  const fs::path file = folder / "run.h5";
  { LogWriter log(file, false, header, model, scene); }
  EXPECT_TRUE(fs::is_empty(folder.path())) << "without a step there is nothing to keep";
  {
    LogWriter log(file, false, header, model, scene);
    write(log, 3, 100);  // long enough for a save at each frame
  }
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(Hdf5Reader(folder / "run.h5.part").root_text("status"), "running");
}

TEST_F(LogTest, WhatThereIsOfARunStaysUntilItHasComeAsFarAgain) {
  const fs::path file = folder / "run.h5", part = folder / "run.h5.part";
  for (const fs::path& earlier : {part, file}) {  // of a kill, of an interrupt
    {
      sim = start(model, scene, "ipopt");
      LogWriter log(file, false, header, model, scene);
      write(log, 23, 1000);  // a save at most steps
      if (earlier == file) log.finish("failed: interrupted", sim);
    }
    const auto steps = [](const fs::path& of) {
      return static_cast<int>(Hdf5Reader(of).shape("/steps/kkt")[0]);
    };
    const int had = steps(earlier);
    ASSERT_GT(had, 15);
    for (const int more : {7, had - 1}) {
      sim = start(model, scene, "ipopt");
      LogWriter log(file, false, header, model, scene, had);
      write(log, more, 1000);
      EXPECT_EQ(steps(earlier), had) << more;
      const auto finish = [&] { log.finish("failed: interrupted", sim); };
      EXPECT_EQ(error_of<FileError>(finish).find(earlier.string() + ": stays as it was"), 0u);
      EXPECT_EQ(steps(earlier), had) << more;
      EXPECT_NE(fs::exists(part), fs::exists(file)) << more;
    }
    EXPECT_FALSE(fs::exists(folder / "run.h5.part.next"));
    sim = start(model, scene, "ipopt");
    LogWriter log(file, false, header, model, scene, had);
    write(log, had + 1, 1000);
    EXPECT_GE(steps(part), had);
    EXPECT_FALSE(fs::exists(file));
    log.finish("complete", sim);
    EXPECT_FALSE(fs::exists(part));
    fs::remove(file);
  }
}

// However little there is of it: a run that goes on replaces no other file.
TEST_F(LogTest, ARunThatGoesOnDoesNotReplaceAWholeLog) {
  const fs::path file = folder / "run.h5", part = folder / "run.h5.part";
  {
    LogWriter log(file, false, header, model, scene);
    write(log, 3);
    log.finish("complete", sim);
  }
  fs::copy_file(file, part);
  EXPECT_THROW(LogWriter(file, true, header, model, scene, 0), FileError);
  EXPECT_TRUE(fs::exists(file) && fs::exists(part));
}

TEST_F(LogTest, TheStateAtTheEndIsTheLastFrame) {
  for (const int steps : {23, 25}) {
    const fs::path file = folder / (std::to_string(steps) + ".h5");
    sim = start(model, scene, "ipopt");
    LogWriter log(file, false, header, model, scene);
    write(log, steps, 0.01);
    log.finish("failed: interrupted", sim);
    const Hdf5Reader ended(file);
    EXPECT_EQ(ended.integers("/trajectory/step"),
              (std::vector<std::int64_t>{0, 5, 10, 15, 20, steps}));
    EXPECT_EQ(ended.rows("/trajectory/q").bottomRows(1).transpose(), sim.now.state.q);
    EXPECT_EQ(ended.doubles("/diagnostics/kinetic_energy").back(), sim.ledger.kinetic);
    EXPECT_TRUE(ended.rows("/forces/head").bottomRows(1).array().isNaN().all());
    EXPECT_TRUE(ended.rows("/mean/forces/head").bottomRows(1).allFinite());
  }
}

// Whoever opens what there is of a run has it as it was then, however the run goes on.
TEST_F(LogTest, WhoReadsARunningLogIsNotDisturbed) {
  LogWriter log(folder / "run.h5", false, header, model, scene);
  write(log, 6, 100);
  const Hdf5Reader then(folder / "run.h5.part");
  const Hdf5Reader::Rows q = then.rows("/trajectory/q");
  write(log, 30, 200);
  EXPECT_EQ(Hdf5Reader(folder / "run.h5.part").shape("/steps/kkt")[0], 36u);
  EXPECT_EQ(then.shape("/steps/kkt")[0], 6u);
  EXPECT_EQ(then.rows("/trajectory/q"), q);
}

TEST_F(LogTest, AFlippedBitInAChunkIsRefused) {
  const fs::path file = folder / "run.h5";
  LogWriter log(file, false, header, model, scene);
  write(log, 6);
  log.finish("complete", sim);
  const H5::H5File h5(file.string(), H5F_ACC_RDONLY);
  hsize_t offset[2] = {0, 0};
  unsigned mask = 0;
  haddr_t address = 0;
  hsize_t bytes = 0;
  const H5::DataSet set = h5.openDataSet("/trajectory/q");
  ASSERT_GE(
      H5Dget_chunk_info(set.getId(), set.getSpace().getId(), 0, offset, &mask, &address, &bytes),
      0);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(address + 20));
  const char byte = static_cast<char>(stream.get() ^ 4);
  stream.seekp(static_cast<std::streamoff>(address + 20));
  stream.put(byte);
  stream.close();
  EXPECT_THROW(Hdf5Reader(file).doubles("/trajectory/q"), FileError);
}

TEST_F(LogTest, AFullDiskIsOneLineAndKeepsWhatWasSaved) {
  // In a child: a limit on file size stands for a full disk and cannot be taken back.
  const fs::path file = folder / "run.h5";
  const auto fill = [&] {
    const rlimit limit{1500000, 1500000};  // room for the header and some frames
    std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      LogWriter log(file, false, header, model, scene);
      std::string cause = "complete";
      try {
        write(log, 3000, 100);  // a save at each frame
      } catch (const FileError& error) {
        cause = error.what();
      }
      log.finish("failed: " + cause, sim);
    } catch (const FileError& error) {
      fprintf(stderr, "%s\n", error.what());
    }
    std::_Exit(1);
  };
  EXPECT_EXIT(fill(), testing::ExitedWithCode(1),
              "run.h5.part: cannot .*: File too large; .*run.h5.part has");
  const Hdf5Reader h5(folder / "run.h5.part");
  EXPECT_EQ(h5.root_text("status").find("failed: "), 0u) << h5.root_text("status");
  EXPECT_GT(h5.shape("/trajectory/time")[0], 0u);
  EXPECT_FALSE(fs::exists(folder / "run.h5.lock"));
}

}  // namespace hagfish::log_test
