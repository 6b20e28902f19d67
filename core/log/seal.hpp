// A seal: a digest of each dataset and attribute of a file, so that what was changed has a name.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hagfish {

/// Where a log has its seal; it is not sealed itself.
inline constexpr const char* seal_path = "/seal";

/// Digests by name: "/group/set" of a dataset's type, shape and values, as they are stored; "/group
/// /set: attribute NAME" of an attribute.
using Seal = std::map<std::string, std::uint32_t>;

/// Of the open file that `object` belongs to, or is. Labels of axes are not looked at: what says so
/// are places in the file. Throws H5::Exception where HDF5 cannot read it.
Seal seal_of(hid_t object);

/// As text, a line "DIGEST NAME" each, and back; lines of another form are left out.
std::string seal_text(const Seal& seal);
Seal read_seal(const std::string& text);

/// Writes the seal of a file into it, or takes out the one that it has. Throws FileError.
void seal_file(const std::filesystem::path& file);
void unseal_file(const std::filesystem::path& file);

/// Names of what `now` has otherwise than `then`, or more or less, with how.
std::vector<std::string> changes(const Seal& then, const Seal& now);

}  // namespace hagfish
