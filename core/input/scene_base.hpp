// A scene file with the scenes that it builds on, as one table.
#pragma once

#include <string>
#include <vector>

#include "core/input/scene_text.hpp"
#include "core/input/toml/toml_reader.hpp"

namespace hagfish {

/// The root table of `scene` with what it inherits by way of `base` (scene_text.hpp), files by
/// `access`, which a scene of a file has. Appends `scene` and its bases to `sources`. Throws
/// InputError for a base that is unknown, unreadable or no TOML, and for bases that form a circle.
TableReader read_with_bases(SceneSource scene, std::vector<SceneSource>& sources,
                            const FileAccess* access);

}  // namespace hagfish
