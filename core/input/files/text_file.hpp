// Text files, read whole.
#pragma once

#include <filesystem>
#include <string>

namespace hagfish {

/// The whole of a text file. Throws InputError where `file` is missing, not a regular file,
/// unreadable or larger than 1 MiB.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace hagfish
