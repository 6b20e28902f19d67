// The audit of a run by the midpoint rule: it closes, and what is logged of the middle of its steps
// goes red when it is false.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <memory>

#include "experiments/audit/audit.hpp"
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

  static std::string objections() { return audit_objections(file); }

  static inline std::unique_ptr<TemporaryFolder> folder;
  static inline std::filesystem::path file;
};

TEST_F(AuditMidpoint, Closes) { EXPECT_EQ(objections(), ""); }

TEST_F(AuditMidpoint, SeesAFalseMiddle) {
  for (const auto& [path, finding] : {std::pair("/midway/moved", "force balance"),
                                      {"/midway/felt", "force balance"},
                                      {"/midway/qdot", "middle of steps"}}) {
    const auto before =
        rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE, [](std::vector<double>& values) {
          for (double& value : values) value *= 2;
        });
    const std::string found = objections();
    EXPECT_NE(found.find(finding), std::string::npos) << path << ": " << found;
    rewrite<double>(file, path, H5::PredType::NATIVE_DOUBLE,
                    [&before](std::vector<double>& values) { values = before; });
  }
}

}  // namespace hagfish::audit_midpoint_test
