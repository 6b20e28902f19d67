// The first and the last part of read_scene_source().
#pragma once

#include <vector>

#include "core/input/scene_text.hpp"
#include "core/input/toml/toml_reader.hpp"

namespace hagfish {

/// The root table of `scene` with what it inherits by way of `base` (scene_text.hpp), files by
/// `access`, which a scene of a file has. Appends `scene` and its bases to `sources`. Throws
/// InputError for a base that is unknown, unreadable or no TOML, and for bases that form a circle.
TableReader read_with_bases(SceneSource scene, std::vector<SceneSource>& sources,
                            const FileAccess* access);

/// Checks what must hold between the keys of a scene, and between it and its animal, where each key
/// by itself is in its range. Throws InputError, whose line names file, key and reason, by `root`,
/// from which scene and specimen of `resolved` were read. Makes its model.
void check_scene(const TableReader& root, ResolvedScene& resolved);

}  // namespace hagfish
