// What an input file must be before it is opened: a device never ends, a pipe waits for a writer.
#pragma once

#include <filesystem>
#include <string>

namespace hagfish {

/// Why `file` is none to be read: missing, a directory, a device, a pipe; empty where it is a
/// regular file, or a symbolic link to one.
std::string unreadable(const std::filesystem::path& file);

}  // namespace hagfish
