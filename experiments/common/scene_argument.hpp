// The scene that a command's SCENE argument names.
#pragma once

#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"

namespace hagfish {

/// A built-in scene's name or a TOML file, with KEY=VALUE overrides. Throws InputError.
ResolvedScene scene_argument(const std::string& scene, const std::vector<std::string>& overrides);

}  // namespace hagfish
