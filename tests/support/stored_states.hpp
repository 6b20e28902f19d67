// States of every phase of the Table 1 run, stored in tests/data.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/scene_run.hpp"

namespace hagfish {

struct StoredState {
  std::string name;  ///< "form early", "slide", ...
  Phase phase = Phase::form;
  std::int64_t step = 0;
  State state;
};

/// How tests of every state name it.
std::string name_of(const testing::TestParamInfo<StoredState>& info);

std::vector<StoredState> stored_states();
/// The one called `name`, which must be there.
StoredState stored_state(const std::string& name);

/// The scene and the animal of that run, at its step: data/table1.toml with `overrides`.
ResolvedScene stored_scene(const std::vector<std::string>& overrides = {});

/// A simulation that goes on from `stored`, its controller in the right phase.
Simulation resume(const Model& model, const Scene& scene, const StoredState& stored,
                  const std::string& back_end = "active-set");
/// The same in stored_scene(overrides).
SceneRun resumed(const StoredState& stored, const std::vector<std::string>& overrides = {});

}  // namespace hagfish
