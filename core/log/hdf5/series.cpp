#include "core/log/hdf5/series.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <type_traits>

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

std::size_t size_of(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

template <class T>
H5::DataType stored_type() {
  if constexpr (std::is_same_v<T, double>) return H5::PredType::NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5::PredType::NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5::PredType::NATIVE_INT64;
  return H5::PredType::NATIVE_UINT8;
}

}  // namespace

AnySeries::AnySeries(SeriesLayout layout, std::size_t value_size)
    : layout_(std::move(layout)), row_size_(size_of(layout_.row_shape)), value_size_(value_size) {}

std::size_t AnySeries::room() const {
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

void AnySeries::write(Hdf5Writer& file) const {
  if (total_ > first_) file.append(layout_, first_, total_ - first_, waiting());
}

void AnySeries::written() {
  keep(0);
  first_ = total_;
}

void AnySeries::cut(hsize_t rows) {
  if (rows >= total_) return;
  keep(rows - first_);
  total_ = rows;
}

template <class T>
void Series<T>::append(const T* row, std::size_t count) {
  if (count != row_size()) throw std::logic_error("log row has the wrong size");
  if (waiting_.empty()) waiting_.reserve(first_rows * row_size());
  waiting_.insert(waiting_.end(), row, row + count);
  if constexpr (std::is_same_v<T, double>) {
    if (const double unit = layout().resolution; unit > 0) {
      std::for_each(waiting_.end() - static_cast<std::ptrdiff_t>(count), waiting_.end(),
                    [unit](double& value) { value = std::round(value / unit) * unit; });
    }
  }
  count_rows(1);
}

template class Series<double>;
template class Series<std::int32_t>;
template class Series<std::int64_t>;
template class Series<std::uint8_t>;

template <class T>
void pack(SeriesLayout& layout) {
  layout.meaning.storage = Storage::packed;
  layout.chunk_columns = 0;
  layout.chunk_rows =
      std::max<hsize_t>(1, compressed_chunk_size / (size_of(layout.row_shape) * sizeof(T)));
}
template void pack<double>(SeriesLayout&);
template void pack<std::int32_t>(SeriesLayout&);
template void pack<std::int64_t>(SeriesLayout&);
template void pack<std::uint8_t>(SeriesLayout&);

template <class T>
SeriesLayout layout_of(const std::string& path, const std::vector<hsize_t>& row_shape,
                       const Meaning& meaning) {
  SeriesLayout layout{path, row_shape, meaning, stored_type<T>(), 1, 0, false, 0, {}};
  if (meaning.storage == Storage::packed) pack<T>(layout);
  if (meaning.storage == Storage::blocks) {
    if (row_shape.size() != 1) throw std::logic_error(path + ": blocks are of rows of one axis");
    const hsize_t columns = row_shape.back();
    const hsize_t blocks = (columns + block_columns - 1) / block_columns;
    layout.chunk_columns = (columns + blocks - 1) / blocks;
  }
  return layout;
}
template SeriesLayout layout_of<double>(const std::string&, const std::vector<hsize_t>&,
                                        const Meaning&);
template SeriesLayout layout_of<std::int32_t>(const std::string&, const std::vector<hsize_t>&,
                                              const Meaning&);
template SeriesLayout layout_of<std::int64_t>(const std::string&, const std::vector<hsize_t>&,
                                              const Meaning&);
template SeriesLayout layout_of<std::uint8_t>(const std::string&, const std::vector<hsize_t>&,
                                              const Meaning&);

SeriesLayout layout_of_choices(const std::string& path, const std::vector<std::string>& names,
                               const Meaning& meaning) {
  H5::EnumType type(H5::PredType::NATIVE_UINT8);
  for (std::size_t k = 0; k < names.size(); ++k) {
    auto value = static_cast<std::uint8_t>(k);
    type.insert(names[k], &value);
  }
  return {path, {}, meaning, type, 1, 0, false, 0, {}};
}

}  // namespace hagfish
