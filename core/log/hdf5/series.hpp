// Datasets that grow by rows while a run goes on, and the rows that wait to be saved.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/log/hdf5/hdf5_writer.hpp"

namespace hagfish {

/// A growing dataset. Its rows wait in memory, as HDF5 takes them, until they are written to the
/// file.
class Series {
 public:
  explicit Series(SeriesLayout layout);

  const SeriesLayout& layout() const { return layout_; }
  /// Creates the dataset in `file`, without rows.
  void create(Hdf5Writer& file) const { file.create(layout_); }
  /// Appends one row of values of the layout's type, `bytes` in all. Doubles are rounded to
  /// multiples of its resolution. Throws std::logic_error where the row has another size.
  void append(const void* row, std::size_t bytes);
  /// Bytes of one row.
  std::size_t row_bytes() const { return row_bytes_; }
  /// Rows so far, saved or not.
  hsize_t rows() const { return total_; }
  /// Drops all but the first `rows`; those dropped must not have been written.
  void cut(hsize_t rows);
  /// Bytes that write() may add to the file.
  std::size_t room() const;
  /// Writes all that waits to the file, which has the rows before.
  void write(Hdf5Writer& file) const;
  /// What was written waits no more.
  void written();
  /// Bytes of what waits.
  std::size_t waiting_bytes() const { return waiting_.size(); }

 private:
  SeriesLayout layout_;
  std::size_t row_bytes_;
  hsize_t first_ = 0;  // rows of the file: those before what waits
  hsize_t total_ = 0;
  std::vector<char> waiting_;
};

using SeriesList = std::vector<std::shared_ptr<Series>>;

/// The type by which HDF5 stores a T.
template <class T>
H5::DataType stored_type() {
  if constexpr (std::is_same_v<T, double>) return H5::PredType::NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5::PredType::NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5::PredType::NATIVE_INT64;
}

/// The layout of a series of values of `type`, whose rows have `row_shape`; with one row a chunk,
/// where its meaning does not ask for more. Throws std::logic_error for blocks of rows of several
/// axes.
SeriesLayout layout_of(const std::string& path, const std::vector<hsize_t>& row_shape,
                       const Meaning& meaning, const H5::DataType& type);

/// Stores a series compressed, in chunks of a size that suits that.
void pack(SeriesLayout& layout);

/// uint8 enumeration whose values count up from 0 in the order of `names`.
H5::DataType choice_type(const std::vector<std::string>& names);

}  // namespace hagfish
