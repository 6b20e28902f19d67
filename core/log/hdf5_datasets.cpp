#include "core/log/hdf5_datasets.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace hagfish {
namespace {

/// Deflate packs no better, to one byte of so many; a dataset with more holds what is not in its
/// file.
constexpr hsize_t densest_packing = 1032;
/// But a small one may leave all to its fill value, bytes.
constexpr hsize_t small_dataset = hsize_t{1} << 20;
/// HDF5 has no larger chunks, bytes.
constexpr hsize_t largest_chunk = std::numeric_limits<std::uint32_t>::max();
/// What Fletcher32 adds, bytes.
constexpr hsize_t checksum_size = 4;

/// A property list, type or space, closed with this.
struct Handle {
  hid_t id;
  herr_t (*close)(hid_t);
  Handle(hid_t opened, herr_t (*closes)(hid_t)) : id(opened), close(closes) {}
  ~Handle() {
    if (id >= 0) close(id);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
};

/// How a dataset is stored.
struct Layout {
  H5D_layout_t kind = H5D_LAYOUT_ERROR;
  std::vector<hsize_t> extent, chunk;  ///< elements
  hsize_t chunk_size = 0;              ///< unpacked, bytes
  std::vector<H5Z_filter_t> filters;   ///< in the order in which they are applied
};

/// None where it makes no sense, or there are filters that are not known here.
std::optional<Layout> layout_of(hid_t plist, hid_t space, hid_t type) {
  Layout layout;
  layout.kind = H5Pget_layout(plist);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || H5Tget_size(type) == 0) return std::nullopt;
  layout.extent.resize(rank);
  if (H5Sget_simple_extent_dims(space, layout.extent.data(), nullptr) != rank) return std::nullopt;
  if (layout.kind != H5D_CHUNKED) return layout;
  layout.chunk.resize(rank);
  layout.chunk_size = H5Tget_size(type);
  if (rank == 0 || H5Pget_chunk(plist, rank, layout.chunk.data()) != rank) return std::nullopt;
  for (const hsize_t length : layout.chunk) {
    if (length == 0 || length > largest_chunk / layout.chunk_size) return std::nullopt;
    layout.chunk_size *= length;
  }
  for (int i = 0; i < H5Pget_nfilters(plist); ++i) {
    unsigned flags = 0, configuration = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(plist, i, &flags, &values, nullptr, 0, nullptr, &configuration);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE &&
        filter != H5Z_FILTER_FLETCHER32) {
      return std::nullopt;
    }
    layout.filters.push_back(filter);
  }
  return layout;
}

/// Whether the filters that `mask` leaves make `stored` of a whole chunk.
bool is_whole(const Layout& layout, const std::vector<Bytef>& stored, std::uint32_t mask) {
  hsize_t size = stored.size();
  for (std::size_t i = layout.filters.size(); i-- > 0;) {
    if ((mask >> i & 1U) != 0) continue;
    if (layout.filters[i] == H5Z_FILTER_FLETCHER32) {
      if (size < checksum_size) return false;
      size -= checksum_size;
    } else if (layout.filters[i] == H5Z_FILTER_DEFLATE) {
      // Checksums that were added before, and what goes beyond them.
      const auto before =
          std::count(layout.filters.begin(), layout.filters.begin() + i, H5Z_FILTER_FLETCHER32);
      std::vector<Bytef> unpacked(layout.chunk_size + before * checksum_size);
      uLongf length = unpacked.size();
      if (uncompress(unpacked.data(), &length, stored.data(), size) != Z_OK) return false;
      size = length;
    }
  }
  return size == layout.chunk_size;
}

/// Copies the chunk at `offset`, if there is one; whether that, or none, is all right.
bool copy_chunk(const Layout& layout, hid_t from, hid_t to, const std::vector<hsize_t>& offset,
                std::vector<Bytef>& stored) {
  std::uint32_t mask = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t size = 0;
  if (H5Dget_chunk_info_by_coord(from, offset.data(), &mask, &address, &size) < 0) return false;
  if (address == HADDR_UNDEF) return true;
  if (size > largest_chunk) return false;
  stored.resize(size);
  return H5Dread_chunk(from, H5P_DEFAULT, offset.data(), &mask, stored.data()) >= 0 &&
         is_whole(layout, stored, mask) &&
         H5Dwrite_chunk(to, H5P_DEFAULT, mask, offset.data(), size, stored.data()) >= 0;
}

/// The next chunk's place, the last axis first; false after the last one.
bool advance(const Layout& layout, std::vector<hsize_t>& offset) {
  for (std::size_t axis = offset.size(); axis-- > 0;) {
    offset[axis] += layout.chunk[axis];
    if (offset[axis] < layout.extent[axis]) return true;
    offset[axis] = 0;
  }
  return false;
}

/// A quantity that does not fit comes out as the largest.
hsize_t product(const std::vector<hsize_t>& factors, hsize_t first) {
  return std::accumulate(factors.begin(), factors.end(), first, [](hsize_t a, hsize_t b) {
    const bool fits = b == 0 || a <= std::numeric_limits<hsize_t>::max() / b;
    return fits ? a * b : std::numeric_limits<hsize_t>::max();
  });
}

/// Whether they were all there. HDF5 reads as many as there should be, wherever they end.
bool copy_elements(const Layout& layout, hid_t from, hid_t to, hid_t type) {
  std::vector<char> elements(product(layout.extent, H5Tget_size(type)));
  const bool never_written = layout.kind == H5D_CONTIGUOUS && H5Dget_offset(from) == HADDR_UNDEF;
  return (never_written || H5Dget_storage_size(from) == elements.size()) &&
         H5Dread(from, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements.data()) >= 0 &&
         H5Dwrite(to, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements.data()) >= 0;
}

/// Whether all chunks were whole.
bool copy_chunks(const Layout& layout, hid_t from, hid_t to) {
  std::vector<hsize_t> offset(layout.extent.size(), 0);
  std::vector<Bytef> stored;
  do {
    if (!copy_chunk(layout, from, to, offset, stored)) return false;
  } while (advance(layout, offset));
  return true;
}

}  // namespace

bool exceeds_file(const std::vector<hsize_t>& extent, std::size_t size, hsize_t file_size) {
  return product(extent, size) > std::max(small_dataset, densest_packing * file_size);
}

bool is_plain(hid_t set) {
  const Handle plist(H5Dget_create_plist(set), H5Pclose);
  const Handle type(H5Dget_type(set), H5Tclose);
  return plist.id >= 0 && type.id >= 0 && H5Pget_layout(plist.id) != H5D_VIRTUAL &&
         H5Pget_external_count(plist.id) == 0 && H5Tdetect_class(type.id, H5T_VLEN) == 0 &&
         H5Tdetect_class(type.id, H5T_REFERENCE) == 0 && H5Tis_variable_str(type.id) == 0;
}

hid_t copy_plain(hid_t set, hid_t to, const char* name) {
  const Handle plist(H5Dget_create_plist(set), H5Pclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const Handle stored_type(H5Dget_type(set), H5Tclose);
  const Handle type(H5Tcopy(stored_type.id), H5Tclose);  // one of the file's own stays there
  const Handle file(H5Iget_file_id(set), H5Fclose);
  const std::optional<Layout> layout = layout_of(plist.id, space.id, type.id);
  hsize_t file_size = 0;
  if (!layout || H5Fget_filesize(file.id, &file_size) < 0) return H5I_INVALID_HID;
  const hid_t copy = H5Dcreate2(to, name, type.id, space.id, H5P_DEFAULT, plist.id, H5P_DEFAULT);
  if (copy < 0 || H5Sget_simple_extent_npoints(space.id) <= 0 ||
      exceeds_file(layout->extent, H5Tget_size(type.id), file_size)) {
    return copy;
  }
  if (!(layout->kind == H5D_CHUNKED ? copy_chunks(*layout, set, copy)
                                    : copy_elements(*layout, set, copy, type.id))) {
    H5Dclose(copy);
    H5Ldelete(to, name, H5P_DEFAULT);
    return H5I_INVALID_HID;
  }
  return copy;
}

}  // namespace hagfish
