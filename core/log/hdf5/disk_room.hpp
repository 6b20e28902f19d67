// Room on the disk and in memory, sure before it is needed: HDF5 can neither close nor abandon a
// file on a full disk.
#pragma once

#include <cstddef>
#include <filesystem>

namespace hagfish {

/// Allocates `bytes` behind the end of a file, which HDF5 cuts off where it does not use them.
/// Returns the system's error number where there is no room, else 0.
[[nodiscard]] int reserve_room(const std::filesystem::path& file, std::size_t bytes);

/// Throws std::bad_alloc where the process cannot have `bytes` more of memory, beside which HDF5
/// crashes: it writes to what it was not given.
void require_memory(std::size_t bytes);

}  // namespace hagfish
