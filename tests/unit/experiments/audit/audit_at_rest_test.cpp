// Runs in which all that figures could be a share of vanishes or cancels: a body that lies on a
// floor, one that falls, and one that swims. Nothing is warned of, and all findings are met.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/log/reading/log_contents.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::audit_at_rest_test {

class AuditAtRest : public testing::TestWithParam<const char*> {
 protected:
  /// An even rod of 20 bodies that no clamp holds, with `more` of its scene.
  void expect_sound(const std::vector<std::string>& more) {
    std::vector<std::string> set{
        "clamp_head=false",
        "wall.present=false",
        "script.kind=none",
        "expect.knot=",
        "expect.types=[]",
        "model.bodies=20",
        "time.step=0.005",
        "time.duration=0.3",
        std::string("time.rule=") + GetParam(),
        "specimen={name='even rod', length=42.4, mass=85.0, station=[0.2, 0.8], "
        "circumference=[5.0, 5.0], bending_limit_deg=[60, 60], bending_span=0.848, "
        "twist_limit_deg=3000}"};
    set.insert(set.end(), more.begin(), more.end());
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "log.h5";
    write_log(file, scene_argument("table1", set));
    EXPECT_EQ(audit_objections(file), "");
    EXPECT_EQ(LogContents(file.string()).h5.root_text("warnings"), "");
  }
};
INSTANTIATE_TEST_SUITE_P(Rules, AuditAtRest, testing::Values("euler", "midpoint"),
                         [](const auto& test) { return std::string(test.param); });

constexpr double radius = 5.0 / (2 * std::numbers::pi);

TEST_P(AuditAtRest, OnAFloorLevelOrTilted) {
  for (const double tilt : {0.0, 33 * std::numbers::pi / 180}) {
    expect_sound({fmt::format("gravity=[0, {}, {}]", 981 * std::sin(tilt), -981 * std::cos(tilt)),
                  fmt::format("obstacle=[{{kind='plane', name='floor', point=[0, 0, {}], "
                              "normal=[0, 0, 1]}}]",
                              -radius)});
  }
}

TEST_P(AuditAtRest, InFreeFall) {
  expect_sound({"gravity=[0, 0, -981]", "drag.normal=0", "drag.tangential=0"});
}

TEST_P(AuditAtRest, AsItDrifts) {
  std::string zeros;
  const int nv = scene_argument("table1", {"model.bodies=20"}).model.nv();
  for (int k = 3; k < nv; ++k) zeros += ", 0";
  expect_sound({"drag.normal=0", "drag.tangential=0",
                "start.bend=[[0.0, 0.0, 0.0, 0.1], [1.0, 0.0, 0.0, 0.1]]", "start.phase=free",
                "start.qdot=[80, 0, 0" + zeros + "]"});
}

TEST_P(AuditAtRest, AsItSwims) {
  const TemporaryFolder folder;
  std::ofstream wave(folder / "wave.csv");
  wave << "time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)\n";
  for (int k = 0; k <= 40; ++k) {
    const double t = 0.05 * k;
    for (int s = 0; s <= 20; ++s) {
      wave << fmt::format("{:.2f},{:.2f},0,{:.6g},0\n", t, s / 20.0,
                          8 * std::min(1.0, t) * std::sin(2 * std::numbers::pi * (s / 20.0 - t)));
    }
  }
  wave.close();
  expect_sound({"drag.normal=2000", "drag.tangential=1000", "script.kind=curvature",
                "script.program='" + (folder / "wave.csv").string() + "'", "active.stiffness=1e9",
                "active.capacity=1e12", "active.tone_time=0.01", "active.relax_time=1",
                "controller.tail_through=1000", "controller.tighten_from=1.5",
                "model.bending_stiffness=4e6", "model.twist_stiffness=4e6", "time.duration=2"});
}

}  // namespace hagfish::audit_at_rest_test
