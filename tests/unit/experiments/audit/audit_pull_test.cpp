// The audit of a run that pulls at food: what is logged of the pull goes red when it is false, and
// so does a log of food that is not the scene's.
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

/// Pulls for 2 s, with a cap that rises in the first of them.
ResolvedScene pulling_scene(std::vector<std::string> set = {}) {
  const std::vector<std::string> all = {"time.step=0.005",
                                        "time.frame_interval=0.1",
                                        "food.average=0.1",
                                        "knot.votes=5",
                                        "food.hold=2",
                                        "food.cap.from=4000",
                                        "food.cap.time=1",
                                        "expect.pull=0.03",
                                        "expect.pull_balance=0.2",
                                        "expect.pull_drift=1"};
  set.insert(set.begin(), all.begin(), all.end());
  return read_scene(std::string(HAGFISH_DATA_DIR) + "/pull_overhand.toml", set);
}

class AuditPull : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    file = *folder / "log.h5";
    const ResolvedScene resolved = pulling_scene();
    const Model model = make_hagfish(resolved.specimen, resolved.scene);
    write_log(file, resolved, model, start(model, resolved.scene, "active-set"),
              std::numeric_limits<int>::max());
  }
  static void TearDownTestSuite() { folder.reset(); }

  static std::string objections() {
    std::string text;
    for (const Finding& finding : audit(file)) {
      text += finding.passed ? "" : finding.name + ": " + finding.text + "\n";
    }
    return text;
  }

  /// What the audit says while the log claims to be of another scene.
  static std::string objections_with(const std::string& set) {
    const ResolvedScene other = pulling_scene({set});
    const std::string before = write_scene(scene_to_toml(other.scene, other.specimen));
    const std::string text = objections();
    write_scene(before);
    return text;
  }
  static std::string write_scene(const std::string& text) {
    std::string before;
    H5::H5File h5(file.string(), H5F_ACC_RDWR);
    H5::Group root = h5.openGroup("/");
    const H5::Attribute attribute = root.openAttribute("scene");
    attribute.read(attribute.getStrType(), before);
    root.removeAttr("scene");
    const H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
    root.createAttribute("scene", type, H5::DataSpace(H5S_SCALAR)).write(type, text);
    return before;
  }

  static std::unique_ptr<TemporaryFolder> folder;
  static fs::path file;
};

std::unique_ptr<TemporaryFolder> AuditPull::folder;
fs::path AuditPull::file;

TEST_F(AuditPull, AGoodLogIsGood) { EXPECT_EQ(objections(), ""); }

TEST_F(AuditPull, WatchesEachFigureWherePulledAndWhereNot) {
  for (const char* path : {"/pull/force", "/pull/plate", "/pull/bearing", "/pull/torque",
                           "/pull/advantage_rows", "/pull/advantage_torque", "/thigmotaxis/cap"}) {
    for (const bool pulled : {true, false}) {
      const auto change = [pulled](std::vector<double>& values) {
        const auto number = std::ranges::find_if(values, [](double v) { return std::isfinite(v); });
        ASSERT_NE(number, values.end());
        // A number off by a millionth; or one where there is none, at the first frame.
        if (pulled) {
          *number *= 1 + 1e-6;
        } else {
          values.front() = 1;
        }
      };
      const auto before = rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE, change);
      EXPECT_NE(objections().find(path), std::string::npos) << objections();
      rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE, [&](auto& v) { v = before; });
    }
  }
  EXPECT_EQ(objections(), "") << "the test did not mend what it changed";
}

TEST_F(AuditPull, SeesFoodAndBoundsThatAreNotTheScenes) {
  const std::pair<const char*, const char*> changes[] = {
      {"food.cap.from=3000", "/thigmotaxis/cap"},
      {"food.cap.to=6000", "/thigmotaxis/cap"},
      {"food.strength=0.01", "food: "},
      {"food.hold=5", "food: "},
      {"expect.pull=1", "pull: "},
      {"expect.pull_drift=0", "pull steady: "},
      {"expect.pull_balance=0", "pull balance: "},
      {"expect.pull_settled=1.9", "too short"}};
  for (const auto& [change, watcher] : changes) {
    const std::string text = objections_with(change);
    EXPECT_NE(text.find(watcher), std::string::npos) << change << ": " << text;
  }
  EXPECT_EQ(objections(), "");
}

}  // namespace
}  // namespace hagfish
