// Scene and specimen files; what is in them: scene_text.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/input/scene_text.hpp"

namespace hagfish {

Specimen read_specimen(const std::filesystem::path& file);

/// Reads a scene file, with overrides as of read_scene_source(). A specimen file is looked for
/// beside the file that names it, or, where an override names it, in the working directory.
ResolvedScene read_scene(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides = {});

/// Reads a scene from text; `name` stands for the file in errors. A file that the text names is
/// looked for in `files` and then among the built-in ones.
ResolvedScene read_scene_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides = {},
                              const TextFiles& files = {});

}  // namespace hagfish
