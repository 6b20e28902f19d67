// A scene file with the scenes that it builds on, as one table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/input/toml_reader.hpp"

namespace hagfish {

/// The text of one scene, before it is read.
struct SceneSource {
  std::string text;
  std::string name;                           ///< in errors
  std::optional<std::filesystem::path> file;  ///< nothing for a text of no file
};

/// The root table of `scene` with what it inherits by way of `base` (scene_reader.hpp). Appends
/// `scene` and its bases to `sources`. Throws InputError for a base that is unknown, unreadable or
/// no TOML, and for bases that form a circle.
TableReader read_with_bases(SceneSource scene, std::vector<SceneSource>& sources);

}  // namespace hagfish
