// The files of data/, compiled in; builtin_files.cmake writes the definition.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hagfish {

/// Text of the file `name` of data/ ("table1.toml", "specimens/pacific_hagfish.toml"), or nothing
/// where there is none.
std::optional<std::string_view> builtin_file(std::string_view name);

/// Names of the scenes, the files of data/ itself except presets.toml, without .toml.
std::vector<std::string_view> builtin_scene_names();

}  // namespace hagfish
