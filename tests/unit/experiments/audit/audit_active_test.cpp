// The audit of a run in which the animal bends itself: what is logged of its muscles goes red when
// it is false, and so does a log of muscles that are not the scene's.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <memory>

#include "experiments/audit/audit.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

ResolvedScene living_scene(std::vector<std::string> set = {}) {
  set.insert(set.end(), {"time.frame_interval=0.2", "knot.votes=5", "time.duration=19.5",
                         "expect.types=[]"});
  return read_scene(std::string(HAGFISH_DATA_DIR) + "/living_overhand_free.toml", set);
}

/// A log of forming, tightening, sliding and release: with a knot that is let go half way.
class AuditActive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    file = *folder / "log.h5";
    const ResolvedScene resolved = living_scene({"controller.release_at=7", "expect.slide_distance=3"});
    const Model model = make_hagfish(resolved.specimen, resolved.scene);
    write_log(file, resolved, model, start(model, resolved.scene, "active-set"),
              std::numeric_limits<int>::max());
  }
  static void TearDownTestSuite() { folder.reset(); }

  /// Names and texts of all findings that fail.
  static std::string objections() {
    std::string text;
    for (const Finding& finding : audit(file)) {
      text += finding.passed ? "" : finding.name + ": " + finding.text + "\n";
    }
    return text;
  }

  /// What the audit says while one entry of `path` (row by row) is off by `by`.
  static std::string objections_to(const std::string& path, std::size_t entry, double by) {
    const auto change = [&](std::vector<double>& values) { values.at(entry) += by; };
    const auto before = rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE, change);
    const std::string text = objections();
    rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE,
                    [&before](std::vector<double>& values) { values = before; });
    return text;
  }

  /// What the audit says while the log claims to be of another scene.
  static std::string objections_with(const std::vector<std::string>& set) {
    std::vector<std::string> all{"controller.release_at=7", "expect.slide_distance=3"};
    all.insert(all.end(), set.begin(), set.end());
    const ResolvedScene other = living_scene(all);
    const std::string before = write_scene(scene_to_toml(other.scene, other.specimen));
    const std::string text = objections();
    write_scene(before);
    return text;
  }
  static std::string write_scene(const std::string& text) {
    std::string before;
    H5::H5File h5(file.string(), H5F_ACC_RDWR);
    H5::Group root = h5.openGroup("/");
    const H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
    root.openAttribute("scene").read(type, before);
    root.removeAttr("scene");
    root.createAttribute("scene", type, H5::DataSpace(H5S_SCALAR)).write(type, text);
    return before;
  }

  /// The first frame of a phase.
  static std::size_t first_frame(Phase phase) {
    const std::vector<std::int64_t> phases = Hdf5Reader(file).integers("/trajectory/phase");
    return static_cast<std::size_t>(
        std::ranges::find(phases, static_cast<std::int64_t>(phase)) - phases.begin());
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static fs::path file;
};

std::unique_ptr<TemporaryFolder> AuditActive::folder;
fs::path AuditActive::file;

TEST_F(AuditActive, AGoodLogIsGood) { EXPECT_EQ(objections(), ""); }

TEST_F(AuditActive, WatchesTheMusclesInEveryPhase) {
  const std::size_t nv = Hdf5Reader(file).shape("/forces/active")[1];
  for (const Phase phase : {Phase::form, Phase::slide, Phase::release}) {
    const std::size_t entry = (first_frame(phase) + 3) * nv + 80;
    // A millionth of what muscles make, 1e5 dyn cm.
    const std::string torque = objections_to("/forces/active", entry, 0.1);
    EXPECT_NE(torque.find("/forces/active"), std::string::npos) << torque;
    EXPECT_NE(torque.find("force balance"), std::string::npos) << torque;
#ifdef HAGFISH_MUJOCO
    EXPECT_NE(torque.find("forward-inverse"), std::string::npos) << torque;
#endif
    const std::string rest = objections_to("/trajectory/q_ref", entry, 1e-6);
    EXPECT_NE(rest.find(phase == Phase::slide ? "/forces/active" : "/trajectory/q_ref"),
              std::string::npos)
        << rest;
    const std::string mean = objections_to("/mean/forces/active", entry, 0.1);
    EXPECT_NE(mean.find("balance of means"), std::string::npos) << mean;
  }
  // A force on the world, however small.
  const std::string root = objections_to("/forces/active", 20 * nv + 2, 1e-9);
  EXPECT_NE(root.find("shape of forces"), std::string::npos) << root;
}

TEST_F(AuditActive, WatchesTheLedgers) {
  const std::string work = objections_to("/diagnostics/work_active", 60, 10);  // of 2e5 erg
  EXPECT_NE(work.find("energy ledger"), std::string::npos) << work;
  const std::string drag = objections_to("/diagnostics/impulse_drag", 60, 0.01);  // of 200 dyn s
  EXPECT_NE(drag.find("momentum ledger"), std::string::npos) << drag;
  const std::string outside = objections_to("/diagnostics/impulse_outside", 60, 1e-9);
  EXPECT_NE(outside.find("nothing outside"), std::string::npos) << outside;
}

TEST_F(AuditActive, SeesMusclesThatAreNotTheScenes) {
  const std::pair<const char*, const char*> changes[] = {{"active.stiffness=2.001e5", "/forces/active"},
                                                         {"active.capacity=1e5", "/forces/active"},
                                                         {"active.tone_time=0.1", "muscle tone"},
                                                         {"active.tone_time=0.001", "muscle tone"},
                                                         {"active.relax_time=1.001", "/trajectory/q_ref"},
                                                         {"script.noise=0.001", "/trajectory/q_ref"}};
  for (const auto& [change, watcher] : changes) {
    const std::string text = objections_with({change});
    EXPECT_NE(text.find(watcher), std::string::npos) << change << ": " << text;
  }
  EXPECT_EQ(objections(), "");
}

}  // namespace
}  // namespace hagfish
