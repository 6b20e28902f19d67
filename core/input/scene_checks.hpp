// What must hold between the keys of a scene, and between it and its animal, where each key by
// itself is in its range.
#pragma once

#include "core/input/scene_text.hpp"
#include "core/input/toml/toml_reader.hpp"

namespace hagfish {

/// Throws InputError, whose line names file, key and reason, by `root`, from which `resolved` was
/// read.
void check_scene(const TableReader& root, const ResolvedScene& resolved);

}  // namespace hagfish
