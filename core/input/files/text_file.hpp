// Text files, read whole, and what may be read at all.
#pragma once

#include <filesystem>
#include <string>

namespace hagfish {

/// Why `file` is none to be read: missing, a directory, a device, which never ends, a pipe, which
/// waits for a writer; empty where it is a regular file, or a symbolic link to one.
std::string unreadable(const std::filesystem::path& file);

/// The whole of a text file. Throws InputError where `file` is missing, not a regular file,
/// unreadable or larger than 1 MiB.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace hagfish
