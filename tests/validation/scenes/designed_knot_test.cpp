// What `hagfish design` finds is right: its own run, its log, and its steps.
#include <gtest/gtest.h>

#include "core/input/files/text_file.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/design/design.hpp"
#include "experiments/design/living_body.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::designed_knot_test {

TEST(DesignedKnot, PassesTheAuditAndAtFinerSteps) {
  const TemporaryFolder folder;
  const auto never = [] { return false; };
  DesignOptions options;
  options.knot = "3_1";
  options.folder = folder.path() / "found";
  options.threads = 2;
  options.seed = 2;
  options.interrupted = never;
  options.progress = [](const std::string&) {};
  ASSERT_TRUE(design(options).found);

  for (const Finding& finding : audit((options.folder / "knot.h5").string())) {
    EXPECT_TRUE(finding.passed) << finding.name << ": " << finding.text;
  }
  FoundScene found;
  found.scene = read_text_file((options.folder / scene_file).string());
  found.program = read_text_file((options.folder / program_file).string());
  // The search has run it at finer steps; what it wrote is what it ran.
  constexpr double step = 0.002;
  EXPECT_EQ(resolved_scene(found, trial_settings({.step = step})).scene.time.step, step);
  EXPECT_EQ(shortcoming(*run_trial(found, {.step = step}, never)), "");
}

}  // namespace hagfish::designed_knot_test
