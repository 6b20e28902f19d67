// Writing rows of series to a file.
#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "core/log/hdf5/hdf5_writer.hpp"

namespace hagfish {
namespace {

bool all_zero(const char* bytes, std::size_t count) {
  return count == 0 || (bytes[0] == 0 && std::memcmp(bytes, bytes + 1, count - 1) == 0);
}

/// Rows in memory that are to be written, from row `first` of their series on.
class WaitingRows {
 public:
  WaitingRows(const SeriesLayout& layout, hsize_t first, hsize_t count, const void* values)
      : layout_(layout),
        first_(first),
        count_(count),
        values_(static_cast<const char*>(values)),
        value_bytes_(layout.type.getSize()),
        row_bytes_(std::accumulate(layout.row_shape.begin(), layout.row_shape.end(),
                                   static_cast<hsize_t>(value_bytes_), std::multiplies<>())) {}

  /// Writes columns [begin, end) of the last axis, all of them where that is from 0 to 0. Chunks of
  /// zeros are left out, as rows without a chunk of their own read as 0: most forces are 0 for
  /// whole phases, and many on most of the body.
  void write(H5::DataSet& set, hsize_t begin, hsize_t end) const {
    const hsize_t last = first_ + count_;
    hsize_t from = first_;
    for (hsize_t at = first_; at < last;) {
      const hsize_t next = std::min(last, (at / layout_.chunk_rows + 1) * layout_.chunk_rows);
      if (zero(at, next, begin, end)) {
        if (from < at) write(set, from, at, begin, end);
        from = next;
      }
      at = next;
    }
    if (from < last) write(set, from, last, begin, end);
  }

 private:
  const char* row(hsize_t i) const { return values_ + (i - first_) * row_bytes_; }

  bool zero(hsize_t from, hsize_t to, hsize_t begin, hsize_t end) const {
    if (end == 0) return all_zero(row(from), (to - from) * row_bytes_);
    for (hsize_t i = from; i < to; ++i) {
      if (!all_zero(row(i) + begin * value_bytes_, (end - begin) * value_bytes_)) return false;
    }
    return true;
  }

  void write(H5::DataSet& set, hsize_t from, hsize_t to, hsize_t begin, hsize_t end) const {
    const std::vector<hsize_t> whole = layout_.shape(to - from);
    const std::vector<hsize_t> size = layout_.shape(to - from, end - begin);
    std::vector<hsize_t> offset(size.size(), 0);
    H5::DataSpace in_memory(static_cast<int>(whole.size()), whole.data());
    if (end > 0) {
      offset.back() = begin;
      in_memory.selectHyperslab(H5S_SELECT_SET, size.data(), offset.data());
    }
    offset[0] = from;
    const H5::DataSpace in_file = set.getSpace();
    in_file.selectHyperslab(H5S_SELECT_SET, size.data(), offset.data());
    set.write(row(from), layout_.type, in_memory, in_file);
  }

  const SeriesLayout& layout_;
  hsize_t first_, count_;
  const char* values_;
  std::size_t value_bytes_;
  hsize_t row_bytes_;
};

}  // namespace

void Hdf5Writer::append(const SeriesLayout& layout, hsize_t first, hsize_t count,
                        const void* values) {
  const std::vector<hsize_t> extent = layout.shape(first + count);
  const WaitingRows rows(layout, first, count, values);
  guarded(name_, "write " + layout.path, [&] {
    H5::DataSet set = h5_.openDataSet(layout.path);
    set.extend(extent.data());
    if (layout.chunk_columns == 0) {
      rows.write(set, 0, 0);
      return;
    }
    const hsize_t columns = layout.row_shape.back();
    for (hsize_t begin = 0; begin < columns; begin += layout.chunk_columns) {
      rows.write(set, begin, std::min(columns, begin + layout.chunk_columns));
    }
  });
}

}  // namespace hagfish
