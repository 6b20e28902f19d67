// The audit of a run in which the animal bends itself: what is logged of its muscles goes red when
// it is false, and so does a log of muscles that are not the scene's.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <memory>

#include "experiments/audit/audit.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_active_test {

namespace fs = std::filesystem;

ResolvedScene living_scene(std::vector<std::string> set = {}) {
  set.insert(set.end(),
             {"time.frame_interval=0.05", "knot.votes=5", "time.duration=15.5", "expect.types=[]",
              "expect.slide_distance=0.5", "expect.slide_share=0", "controller.release_at=10.5"});
  return read_scene(std::string(HAGFISH_DATA_DIR) + "/living_overhand_free.toml", set);
}

/// A log of every phase but the last: the knot is let go soon after it begins to slide.
class AuditActive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    file = *folder / "log.h5";
    write_log(file, living_scene());
  }
  static void TearDownTestSuite() { folder.reset(); }

  /// Names and texts of all findings that fail, but that of the knot, which is still there.
  static std::string objections() { return audit_objections(file, "unknot at end"); }

  /// An entry of a dataset, row by row, and how far it is off.
  struct Corruption {
    std::string path;
    std::size_t entry = 0;
    double by = 0;
  };
  /// What the audit says while entries are off.
  static std::string objections_to(const std::vector<Corruption>& corruptions) {
    const auto add = [](const Corruption& c, double sign) {
      rewrite<double>(file, c.path, H5::PredType::NATIVE_DOUBLE,
                      [&](std::vector<double>& values) { values.at(c.entry) += sign * c.by; });
    };
    for (const Corruption& c : corruptions) add(c, 1);
    const std::string text = objections();
    for (const Corruption& c : corruptions) add(c, -1);
    return text;
  }

  /// The first frame of a phase.
  static std::size_t first_frame(Phase phase) {
    const std::vector<std::int64_t> phases = Hdf5Reader(file).integers("/trajectory/phase");
    return static_cast<std::size_t>(std::ranges::find(phases, static_cast<std::int64_t>(phase)) -
                                    phases.begin());
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static fs::path file;
};

std::unique_ptr<TemporaryFolder> AuditActive::folder;
fs::path AuditActive::file;

TEST_F(AuditActive, AGoodLogIsGood) { EXPECT_EQ(objections(), ""); }

// The torque of sliding is bounded by a share of the capacity: a smaller capacity is passed.
TEST_F(AuditActive, BoundsTheTorqueOfTheSlide) {
  const fs::path weak = *folder / "weak.h5";
  write_log(weak, living_scene({"expect.torque_share=0.2"}));
  EXPECT_NE(audit_objections(weak, "unknot at end").find("torque"), std::string::npos);
}

TEST_F(AuditActive, WatchesTheMusclesInEveryPhase) {
  const std::size_t nv = Hdf5Reader(file).shape("/forces/active")[1];
  for (const Phase phase : {Phase::form, Phase::slide, Phase::release}) {
    const std::size_t entry = (first_frame(phase) + 3) * nv + 80;
    // A millionth of what muscles make, 1e5 dyn cm.
    const std::string torque =
        objections_to({{"/forces/active", entry, 0.1}, {"/mean/forces/active", entry, 0.1}});
    std::vector<std::string> watchers = {"/forces/active", "force balance", "balance of means"};
#ifdef HAGFISH_MUJOCO
    watchers.emplace_back("forward-inverse");
#endif
    for (const std::string& watcher : watchers) {
      EXPECT_NE(torque.find(watcher), std::string::npos) << watcher << " in " << torque;
    }
    const std::string rest = objections_to({{"/trajectory/q_ref", entry, 1e-6}});
    EXPECT_NE(rest.find(phase == Phase::slide ? "/forces/active" : "/trajectory/q_ref"),
              std::string::npos)
        << rest;
  }
}

TEST_F(AuditActive, WatchesTheLedgersAndTheWorld) {
  const std::size_t nv = Hdf5Reader(file).shape("/forces/active")[1];
  const std::string text = objections_to({{"/diagnostics/work_active", 60, 10},     // of 1e5 erg
                                          {"/diagnostics/impulse_drag", 60, 0.01},  // of 100 dyn s
                                          {"/diagnostics/impulse_outside", 60, 1e-9},
                                          // A force on the world, however small.
                                          {"/forces/active", 20 * nv + 2, 1e-9}});
  for (const char* watcher :
       {"energy ledger", "momentum ledger", "nothing outside", "muscles hold on to nothing"}) {
    EXPECT_NE(text.find(watcher), std::string::npos) << watcher << " in " << text;
  }
}

TEST_F(AuditActive, SeesMusclesThatAreNotTheScenes) {
  const std::pair<const char*, const char*> changes[] = {
      {"active.stiffness=2.001e5", "/forces/active"},
      {"active.capacity=1e5", "/forces/active"},
      {"active.tone_time=0.1", "muscle tone"},
      {"active.relax_time=1.001", "/trajectory/q_ref"},
      {"script.noise=0.001", "/trajectory/q_ref"}};
  for (const auto& [change, watcher] : changes) {
    const std::string text = audit_objections_as(file, living_scene({change}), "unknot at end");
    EXPECT_NE(text.find(watcher), std::string::npos) << change << ": " << text;
  }
  EXPECT_EQ(objections(), "");
}

// Where the head pulls at what does not give, the animal comes to rest: 1e-6 rad/s under 1e5 dyn cm
// of each kind, so that rounding alone is 3e-8 of q̇.
TEST(AuditAtRest, KnowsVelocitiesAsWellAsForcesMakeThem) {
  const TemporaryFolder folder;
  const fs::path file = folder / "log.h5";
  write_log(file, read_scene(std::string(HAGFISH_DATA_DIR) + "/reflex_pull_figure_eight.toml",
                             {"time.frame_interval=0.1", "expect.types=[]"}));
  EXPECT_EQ(audit_objections(file), "");
  const std::vector<std::int64_t> phases = Hdf5Reader(file).integers("/trajectory/phase");
  const auto last = std::ranges::find(phases, static_cast<std::int64_t>(Phase::release));
  const Hdf5Reader::Rows qdot = Hdf5Reader(file).rows("/trajectory/qdot");
  const auto frame = static_cast<Eigen::Index>(last - phases.begin()) - 1;
  const auto entry = static_cast<std::size_t>(frame * qdot.cols() + 80);
  ASSERT_LT(qdot.row(frame).norm(), 1e-3);
  rewrite<double>(file, "/forces/active", H5::PredType::NATIVE_DOUBLE,
                  [&](std::vector<double>& values) { values.at(entry) += 0.1; });
#ifdef HAGFISH_MUJOCO
  EXPECT_NE(audit_objections(file).find("forward-inverse"), std::string::npos);
#endif
}

}  // namespace hagfish::audit_active_test
