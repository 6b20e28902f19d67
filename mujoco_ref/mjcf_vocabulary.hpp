// Which MJCF is loaded from a file that anybody may have written: MJCF can name other files
// (meshes, height fields, textures, plugins), and ask for any amount of memory.
#pragma once

#include <map>
#include <string>

namespace hagfish {

/// Throws std::runtime_error, one line with the file's name, where one of `files` (MJCF texts by
/// name) is not XML, holds an element or an attribute that mjcf_files() (mjcf.hpp) never writes,
/// includes what is not one of `files` or is included already, or has more bodies than a scene may
/// have.
void check_vocabulary(const std::map<std::string, std::string>& files);

}  // namespace hagfish
