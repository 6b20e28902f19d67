// The audit of muscles: activations, what they fall short of, and those that move the animal go red
// when they are false.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_activation_test {

/// A log of the stored slide, some steps long, by a law.
class AuditActivation : public testing::TestWithParam<std::string> {};

TEST_P(AuditActivation, WatchesWhatMusclesDo) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.h5";
  write_log(
      file,
      resumed(stored_state("slide"),
              {"controller.law=" + GetParam(), "muscle.present=true", "muscle.activation_time=0.1",
               "time.frame_interval=0.01", "knot.votes=5", "expect.types=[]"}),
      63);
  const std::string good = audit_objections(file);
  for (const char* wrong : {"/muscle", "activation", "muscles", "/forces", "/eq6", "/steps",
                            "/thigmotaxis", "balance", "inverse"}) {
    EXPECT_EQ(good.find(wrong), std::string::npos) << good;
  }
  // Of muscles that pull.
  const auto active = [](auto change) {
    return one([=](double a) { return a > 1e-5 ? change(a) : a; });
  };
  expect_watched(file, "/muscle/activation", active([](double a) { return a + 1e-6; }),
                 {"/muscle/activation", "/muscle/residual"});
  expect_watched(file, "/muscle/residual", one([](double u) { return u == 0 ? u : u + 0.01; }),
                 {"/muscle/residual"});
  expect_watched(file, "/muscle/activation", active([](double) { return 1.5; }),
                 {"not an activation from 0 to 1"});
  if (GetParam() == "muscles") {
    expect_watched(file, "/muscle/driven", active([](double a) { return 1.001 * a; }),
                   {"/forces/active"});
    expect_watched(file, "/muscle/driven", active([](double) { return 0.9; }),
                   {"activation dynamics"});
  }
  EXPECT_EQ(audit_objections(file), good);
}

INSTANTIATE_TEST_SUITE_P(Laws, AuditActivation, testing::Values("paper", "muscles"),
                         [](const auto& law) { return law.param; });

}  // namespace hagfish::audit_activation_test
