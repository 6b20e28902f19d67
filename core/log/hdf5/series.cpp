#include "core/log/hdf5/series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace hagfish {
namespace {

// A compressed chunk that is not full is compressed again at each save, to another size and place.
// Where saves are 7 frames apart, chunks of 64 rows of 200 numbers leave holes as large as a third
// of the file, chunks of 8 rows a twentieth; that is this size, bytes.
constexpr hsize_t compressed_chunk_size = 16384;
// Room for an index node and the header of a dataset that grows, and for a chunk's entry, bytes.
constexpr std::size_t index_size = 4096;
constexpr std::size_t index_entry = 128;
// Columns of a block: of 155 hinges, 5 blocks. Half as many leave a tenth less to write, in twice
// as many chunks.
constexpr hsize_t block_columns = 32;
// Rows that wait for a save have room for so many from the first one on. What is not used costs
// nothing, and a run of the Table 1 scene grows to 938 frames.
constexpr std::size_t first_rows = 1024;

/// Bytes of one row.
std::size_t row_bytes_of(const SeriesLayout& layout) {
  return std::accumulate(layout.row_shape.begin(), layout.row_shape.end(), layout.type.getSize(),
                         std::multiplies<>());
}

}  // namespace

Series::Series(SeriesLayout layout)
    : layout_(std::move(layout)), row_bytes_(row_bytes_of(layout_)) {}

void Series::append(const void* row, std::size_t bytes) {
  if (bytes != row_bytes_) throw std::logic_error("log row has the wrong size");
  if (waiting_.empty()) waiting_.reserve(first_rows * bytes);
  const auto* const values = static_cast<const char*>(row);
  waiting_.insert(waiting_.end(), values, values + bytes);
  if (const double unit = layout_.resolution; unit > 0) {
    for (char* at = waiting_.data() + waiting_.size() - bytes; bytes > 0; at += sizeof(double)) {
      double value;
      std::memcpy(&value, at, sizeof value);
      value = std::round(value / unit) * unit;
      std::memcpy(at, &value, sizeof value);
      bytes -= sizeof value;
    }
  }
  ++total_;
}

std::size_t Series::room() const {
  const hsize_t chunk = layout_.chunk_rows;
  const hsize_t begin = first_ / chunk;
  const hsize_t end = (total_ + chunk - 1) / chunk;
  hsize_t blocks = 1;
  hsize_t width = row_bytes();
  if (const hsize_t columns = layout_.chunk_columns; columns > 0) {
    const hsize_t all = layout_.row_shape.back();
    blocks = (all + columns - 1) / columns;
    width = width / all * blocks * columns;  // the last block is as wide as the others
  }
  return index_size + (end - begin) * (chunk * width + blocks * index_entry);
}

void Series::write(Hdf5Writer& file) const {
  if (total_ > first_) file.append(layout_, first_, total_ - first_, waiting_.data());
}

void Series::written() {
  waiting_.clear();
  first_ = total_;
}

void Series::cut(hsize_t rows) {
  if (rows >= total_) return;
  waiting_.resize((rows - first_) * row_bytes_);
  total_ = rows;
}

void pack(SeriesLayout& layout) {
  layout.meaning.storage = Storage::packed;
  layout.chunk_columns = 0;
  layout.chunk_rows = std::max<hsize_t>(1, compressed_chunk_size / row_bytes_of(layout));
}

SeriesLayout layout_of(const std::string& path, const std::vector<hsize_t>& row_shape,
                       const Meaning& meaning, const H5::DataType& type) {
  SeriesLayout layout{path, row_shape, meaning, type, 1, 0, false, 0, {}};
  if (meaning.storage == Storage::packed) pack(layout);
  if (meaning.storage == Storage::blocks) {
    if (row_shape.size() != 1) throw std::logic_error(path + ": blocks are of rows of one axis");
    const hsize_t columns = row_shape.back();
    const hsize_t blocks = (columns + block_columns - 1) / block_columns;
    layout.chunk_columns = (columns + blocks - 1) / blocks;
  }
  return layout;
}

H5::DataType choice_type(const std::vector<std::string>& names) {
  H5::EnumType type(H5::PredType::NATIVE_UINT8);
  for (std::size_t k = 0; k < names.size(); ++k) {
    auto value = static_cast<std::uint8_t>(k);
    type.insert(names[k], &value);
  }
  return H5::DataType(type.getId());
}

}  // namespace hagfish
