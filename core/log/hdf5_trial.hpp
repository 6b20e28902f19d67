// Whether HDF5 comes through with a file at all, found out where it can do no harm.
#pragma once

#include <filesystem>

namespace hagfish {

/// Reads through `file` in a process of its own: all objects, attributes and numbers. HDF5 1.10 as
/// Debian 12 has it crashes on some damaged files and never ends on others; here that ends the
/// other process alone. Throws FileError in one line where it does, or where the process needs more
/// than 2 s of CPU time and 1 s for each 20 MB. What HDF5 itself refuses is no failure here.
void try_hdf5(const std::filesystem::path& file);

}  // namespace hagfish
