// The log against its contract: datasets by name, unit and description; nothing half-written under
// the final name; a full disk or an existing file in one line.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>

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

TEST_F(LogTest, HoldsWhatItsReadersNameInTheirUnits) {
  const fs::path file = folder / "run.h5";
  LogWriter log(file, false, header, model, scene);
  write(log, 12);
  log.finish("complete", sim);
  const Hdf5Reader h5(file);
  // Shapes are log_schema.cpp's.
  const std::map<std::string, std::vector<std::string>> named = {
      {"g", {"model/mass"}},
      {"cm",
       {"model/length", "model/radius", "trajectory/position", "knot/head_end", "knot/tail_end",
        "diagnostics/penetration", "diagnostics/head_drift"}},
      {"rad",
       {"model/limit_lower", "model/limit_upper", "model/bending_limit",
        "diagnostics/limit_violation"}},
      {"s", {"trajectory/time", "diagnostics/wall_time"}},
      {"1",
       {"trajectory/step", "trajectory/phase", "thigmotaxis/body_a", "thigmotaxis/body_b",
        "knot/determinant", "knot/v2", "knot/agreement", "diagnostics/solve", "diagnostics/rows",
        "diagnostics/active", "diagnostics/contacts", "diagnostics/iterations",
        "diagnostics/skin_fold"}},
      {"mixed: cm, 1, rad", {"trajectory/q"}},
      {"cm/s, rad/s", {"trajectory/qdot"}},
      {"dyn, dyn·cm",
       {"forces/thigmotaxis", "forces/contact", "forces/limit", "forces/head", "forces/wall"}},
      {"dyn", {"forces/tip", "thigmotaxis/lambda"}},
      {"cm/s", {"thigmotaxis/speed", "thigmotaxis/slack"}},
      {"erg",
       {"diagnostics/kinetic_energy", "diagnostics/work_thigmotaxis", "diagnostics/work_tip",
        "diagnostics/dissipated"}}};
  for (const auto& [unit, paths] : named) {
    for (const std::string& path : paths) {
      ASSERT_TRUE(h5.has("/" + path)) << path;
      EXPECT_EQ(h5.attribute("/" + path, "unit"), unit) << path;
      EXPECT_FALSE(h5.attribute("/" + path, "description").empty()) << path;
    }
  }
  EXPECT_EQ(h5.texts("/model/dof_name").size(), static_cast<std::size_t>(model.nv()));
  EXPECT_EQ(h5.texts("/model/joint_name").at(1), "j01_bend");
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

TEST_F(LogTest, ReadsBackTheVeryStatesAndEndsWithTheLastOne) {
  for (const int steps : {23, 25}) {
    const fs::path file = folder / (std::to_string(steps) + ".h5");
    sim = start(model, scene, "ipopt");
    LogWriter log(file, false, header, model, scene);
    std::vector<State> states = write(log, steps, 0.01);
    states.push_back(sim.now.state);
    log.finish("failed: interrupted", sim);
    const Hdf5Reader ended(file);
    EXPECT_EQ(ended.integers("/trajectory/step"),
              (std::vector<std::int64_t>{0, 5, 10, 15, 20, steps}));
    for (int frame = 0; frame < 6; ++frame) {
      const State& state = states.at(std::min(5 * frame, steps));
      EXPECT_EQ(ended.rows("/trajectory/q").row(frame).transpose(), state.q);
      EXPECT_EQ(ended.rows("/trajectory/qdot").row(frame).transpose(), state.qdot);
    }
    EXPECT_EQ(ended.doubles("/diagnostics/kinetic_energy").back(), sim.ledger.kinetic);
    EXPECT_TRUE(ended.rows("/forces/head").bottomRows(1).array().isNaN().all());
    EXPECT_TRUE(ended.rows("/mean/forces/head").bottomRows(1).allFinite());
    // The scene in the log makes the run again.
    const ResolvedScene again = read_scene_text(ended.root_text("scene"), "log");
    EXPECT_EQ(again.scene.time.step, scene.time.step);
    EXPECT_EQ(again.specimen.mass, table1_specimen().mass);
  }
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
