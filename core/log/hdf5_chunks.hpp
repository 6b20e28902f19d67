// Datasets of chunks, copied chunk by chunk.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <vector>

namespace hagfish {

/// Whether a dataset of `extent` elements of `size` bytes says that it holds more than a file of
/// `file_size` bytes can.
bool exceeds_file(const std::vector<hsize_t>& extent, std::size_t size, hsize_t file_size);

/// Whether `set` is stored in chunks that can be copied as they are: its elements lead nowhere
/// else.
bool is_chunked(hid_t set);

/// Copies the chunks of `set` as they are, with their checksums, to a new dataset `name` of the
/// group `to`, without attributes. HDF5 1.10 takes each chunk to have the size that the layout
/// says, and reads beyond one that has not: such a dataset is refused. One that exceeds its file is
/// copied without chunks. The copy, or a negative number.
hid_t copy_chunked(hid_t set, hid_t to, const char* name);

}  // namespace hagfish
