// Copies of datasets from a file that cannot be trusted.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <vector>

namespace hagfish {

/// Whether a dataset of `extent` elements of `size` bytes says that it holds more than a file of
/// `file_size` bytes can.
bool exceeds_file(const std::vector<hsize_t>& extent, std::size_t size, hsize_t file_size);

/// Whether the elements of `set` are in its file and lead nowhere else.
bool is_plain(hid_t set);

/// Copies such a dataset to a new one, `name` of the group `to`, without attributes; chunks as they
/// are, with their checksums. HDF5 1.10 takes each chunk to have the size that the layout says, and
/// reads beyond one that has not: such a dataset is refused. One that exceeds its file is copied
/// without its elements. The copy, or a negative number.
hid_t copy_plain(hid_t set, hid_t to, const char* name);

}  // namespace hagfish
