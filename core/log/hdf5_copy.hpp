// A copy of a foreign HDF5 file that HDF5 can be trusted with.
#pragma once

#include <H5Cpp.h>

#include <filesystem>

namespace hagfish {

/// Where the link leads that stands in a copy for a dataset that copy_plain refuses.
inline constexpr const char* damaged_link = "damaged";

/// What `file` holds, opened in memory. HDF5 1.10 as Debian 12 has it crashes on some damaged
/// files, comes to no end on others, and on some writes over its own memory: so a process of its
/// own reads the file and writes it anew, object by object, and this one opens what that wrote.
/// Axes are labelled as they were; chunks are copied as they are, with their checksums; objects
/// that HDF5 refuses to copy are missing; links lead nowhere, and numbers in other files stay
/// there. Throws FileError in one line where HDF5 crashes on the file, needs more than 2 s of CPU
/// time and 1 s for each 20 MB, or has no room, or where the file is not HDF5.
H5::H5File open_hdf5_copy(const std::filesystem::path& file);

/// Writes such a copy to `file`. Throws FileError, and leaves none, where that fails.
void save_hdf5(const H5::H5File& copy, const std::filesystem::path& file);

}  // namespace hagfish
