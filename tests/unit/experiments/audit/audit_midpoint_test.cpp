// The audit of a run by the midpoint rule: it closes, and what is logged of the middle of its steps
// goes red when it is false.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_midpoint_test {

TEST(AuditMidpoint, ClosesAndSeesAFalseMiddle) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  write_log(file, scene_argument("table1",
                                 {"time.rule=midpoint", "time.step=0.01", "time.frame_interval=0.2",
                                  "knot.votes=5", "expect.slide_distance=8"}));
  EXPECT_EQ(audit_objections(file), "");
  const auto doubled = every([](double value) { return 2 * value; });
  expect_watched(file, "/midway/moved", doubled, {"force balance"});
  expect_watched(file, "/midway/felt", doubled, {"force balance"});
  expect_watched(file, "/midway/qdot", doubled, {"middle of steps"});
}

}  // namespace hagfish::audit_midpoint_test
