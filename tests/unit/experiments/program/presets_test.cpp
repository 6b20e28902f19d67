#include "experiments/common/presets.hpp"

#include <gtest/gtest.h>

#include "core/input/builtin_files.hpp"
#include "experiments/common/scene_argument.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish::presets_test {

TEST(Presets, FitEveryScene) {
  for (const Preset& preset : presets()) {
    EXPECT_NO_THROW(make_box_qp_solver(preset.qp)) << preset.name;
    for (const std::string_view scene : builtin_scene_names()) {
      EXPECT_NO_THROW(scene_argument(std::string(scene), preset.set)) << preset.name << scene;
    }
  }
}

// The longer the step, the cheaper and the rougher.
TEST(Presets, QuickTakesLongerStepsThanTheScene) {
  const auto step = [](const std::vector<std::string>& set) {
    return scene_argument("table1", set).scene.time.step;
  };
  EXPECT_GT(step(preset_called("quick").set), step({}));
}

TEST(Presets, AreNoScene) {
  for (const std::string_view scene : builtin_scene_names()) EXPECT_NE(scene, "presets");
}

}  // namespace hagfish::presets_test
