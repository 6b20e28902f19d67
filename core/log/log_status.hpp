// The status of a log that was saved before its run failed.
#pragma once

#include <filesystem>
#include <string>

namespace hagfish {

/// Sets the root attribute `status` of a saved log where it stands, without more room on the disk.
/// False where the new text needs more, or the file is no log; it is then as it was.
bool set_status_in_place(const std::filesystem::path& file, const std::string& status);

}  // namespace hagfish
