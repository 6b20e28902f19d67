// The audit of a run that pulls at food: a log of food or bounds that are not the scene's goes red.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_pull_test {

/// Pulls for 2 s.
ResolvedScene pulling_scene(std::vector<std::string> set = {}) {
  const std::vector<std::string> all = {"time.step=0.005",        "time.frame_interval=0.1",
                                        "food.average=0.1",       "food.hold=2",
                                        "knot.votes=5",           "expect.pull=0.03",
                                        "expect.pull_drift=1",    "expect.pull_settled=0.5",
                                        "expect.pull_balance=0.2"};
  set.insert(set.begin(), all.begin(), all.end());
  return scene_argument("pull_overhand", set);
}

TEST(AuditPull, ClosesWhereTheCapRises) {
  const TemporaryFolder folder;
  write_log(folder / "log.h5", pulling_scene({"food.cap.from=4000", "food.cap.time=1"}));
  EXPECT_EQ(audit_objections(folder / "log.h5"), "");
}

TEST(AuditPull, SeesFoodAndBoundsThatAreNotTheScenes) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  write_log(file, pulling_scene());
  EXPECT_EQ(audit_objections(file), "");
  const std::pair<const char*, const char*> changes[] = {
      {"food.strength=0.01", "food: "},
      {"food.hold=5", "food: "},
      {"expect.pull=1", "pull: "},
      {"expect.pull_drift=0", "pull steady: "},
      {"expect.pull_balance=0", "pull balance: "},
      {"expect.pull_settled=1.9", "too few"}};
  for (const auto& [change, watcher] : changes) {
    const std::string text = audit_objections_as(file, pulling_scene({change}));
    EXPECT_NE(text.find(watcher), std::string::npos) << change << ": " << text;
  }
  EXPECT_EQ(audit_objections(file), "");
}

}  // namespace hagfish::audit_pull_test
