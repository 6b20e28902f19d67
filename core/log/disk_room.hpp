// Room on the disk, taken before it is needed: HDF5 can neither close nor abandon a file on a full
// disk.
#pragma once

#include <cstddef>
#include <filesystem>

namespace hagfish {

/// Allocates `bytes` behind the end of a file, which HDF5 cuts off where it does not use them.
/// Returns the system's error number where there is no room, else 0.
[[nodiscard]] int reserve_room(const std::filesystem::path& file, std::size_t bytes);

}  // namespace hagfish
