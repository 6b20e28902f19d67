// The audit of muscles: activations, what they fall short of, and those that move the animal go red
// when they are false.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/muscled_hagfish.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_activation_test {

namespace fs = std::filesystem;

ResolvedScene scene_of(const std::string& law) {
  return stored_scene({"controller.law=" + law, "muscle.present=true", "muscle.activation_time=0.1",
                       "time.frame_interval=0.01", "knot.votes=5", "expect.types=[]"});
}

/// Logs of the stored slide, some steps long.
class AuditActivation : public testing::TestWithParam<std::string> {
 protected:
  AuditActivation() {
    const ResolvedScene resolved = scene_of(GetParam());
    const Model model = make_hagfish(resolved.specimen, resolved.scene);
    write_log(file, resolved, model, resume(model, resolved.scene, stored_states().at(3)), 63);
  }
  std::string objections() const { return audit_objections(file); }
  /// What the audit says while one entry of the fifth frame or so, larger than `least`, is changed.
  template <class Change>
  std::string objections_to(const std::string& path, double least, Change change) {
    return objections_while(file, path, [&](std::vector<double>& values) {
      const auto found = std::find_if(values.begin() + values.size() / 3, values.end(),
                                      [&](double v) { return std::abs(v) > least; });
      ASSERT_NE(found, values.end()) << path;
      *found = change(*found);
    });
  }

  TemporaryFolder folder;
  fs::path file = folder / "log.h5";
};

TEST_P(AuditActivation, WatchesWhatMusclesDo) {
  const std::string good = objections();
  for (const char* wrong : {"/muscle", "activation", "muscles", "/forces", "/eq6", "/steps",
                            "/thigmotaxis", "balance", "inverse"}) {
    EXPECT_EQ(good.find(wrong), std::string::npos) << good;
  }
  const std::string more =
      objections_to("/muscle/activation", 1e-5, [](double a) { return a + 1e-6; });
  EXPECT_NE(more.find("/muscle/activation"), std::string::npos) << more;
  EXPECT_NE(more.find("/muscle/residual"), std::string::npos) << more;
  const std::string off = objections_to("/muscle/residual", 0, [](double u) { return u + 0.01; });
  EXPECT_NE(off.find("/muscle/residual"), std::string::npos) << off;
  const std::string beyond = objections_to("/muscle/activation", 1e-5, [](double) { return 1.5; });
  EXPECT_NE(beyond.find("not an activation from 0 to 1"), std::string::npos) << beyond;
  if (GetParam() == "muscles") {
    const std::string other =
        objections_to("/muscle/driven", 1e-5, [](double a) { return 1.001 * a; });
    EXPECT_NE(other.find("/forces/active"), std::string::npos) << other;
    const std::string jump = objections_to("/muscle/driven", 1e-5, [](double) { return 0.9; });
    EXPECT_NE(jump.find("activation dynamics"), std::string::npos) << jump;
  }
  EXPECT_EQ(objections(), good);
}

INSTANTIATE_TEST_SUITE_P(Laws, AuditActivation, testing::Values("paper", "muscles"),
                         [](const auto& law) { return law.param; });

}  // namespace hagfish::audit_activation_test
