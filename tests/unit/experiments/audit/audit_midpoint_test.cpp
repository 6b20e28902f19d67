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

// One number of it, of the whole animal's velocity, which no row and no force shows.
TEST_F(AuditMidpoint, SeesAFalseWayOfOneStep) {
  const auto change = [](double by) {
    rewrite<double>(file, "/midway/qdot", H5::PredType::NATIVE_DOUBLE,
                    [by](std::vector<double>& values) { values[values.size() / 2] += by; });
  };
  change(0.001);
  EXPECT_NE(objections().find("/steps/middle_off"), std::string::npos) << objections();
  change(-0.001);
}

// How the middle was found: a guess that is none, and a measure without a second pass.
TEST_F(AuditMidpoint, SeesFalsePasses) {
  const auto remaining = rewrite<double>(file, "/steps/remaining", H5::PredType::NATIVE_DOUBLE,
                                         [](std::vector<double>& values) {
                                           for (double& value : values) value *= 0.5;
                                         });
  EXPECT_NE(objections().find("passes of steps"), std::string::npos) << objections();
  rewrite<double>(file, "/steps/remaining", H5::PredType::NATIVE_DOUBLE,
                  [&remaining](std::vector<double>& values) { values = remaining; });
  const auto before = rewrite<std::int32_t>(file, "/steps/passes", H5::PredType::NATIVE_INT32,
                                            [](std::vector<std::int32_t>& values) {
                                              std::int32_t& some = values[values.size() / 2];
                                              some = some == 1 ? 2 : 1;
                                            });
  EXPECT_NE(objections().find("passes of steps"), std::string::npos) << objections();
  rewrite<std::int32_t>(file, "/steps/passes", H5::PredType::NATIVE_INT32,
                        [&before](std::vector<std::int32_t>& values) { values = before; });
  EXPECT_EQ(objections(), "");
}

}  // namespace hagfish::audit_midpoint_test
