// The audit of a run by the midpoint rule: it closes, and what is logged of the middle of its steps
// goes red when it is false.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_midpoint_test {

class AuditMidpoint : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    file = *folder / "log.h5";
    const ResolvedScene resolved =
        read_scene(std::string(HAGFISH_DATA_DIR) + "/table1.toml",
                   {"time.rule=midpoint", "time.step=0.01", "time.frame_interval=0.2",
                    "knot.votes=5", "expect.slide_distance=8"});
    write_log(file, resolved);
  }
  static void TearDownTestSuite() { folder.reset(); }

  static inline std::unique_ptr<TemporaryFolder> folder;
  static inline std::filesystem::path file;
};

TEST_F(AuditMidpoint, Closes) { EXPECT_EQ(audit_objections(file), ""); }

TEST_F(AuditMidpoint, SeesAFalseMiddle) {
  for (const auto& [path, finding] : {std::pair("/midway/moved", "force balance"),
                                      {"/midway/felt", "force balance"},
                                      {"/midway/qdot", "middle of steps"}}) {
    const std::string found = objections_while(file, path, [](std::vector<double>& values) {
      for (double& value : values) value *= 2;
    });
    EXPECT_NE(found.find(finding), std::string::npos) << path << ": " << found;
  }
}

}  // namespace hagfish::audit_midpoint_test
