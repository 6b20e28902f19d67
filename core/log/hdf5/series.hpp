// Datasets that grow by rows while a run goes on, and the rows that wait to be saved.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/log/hdf5/hdf5_writer.hpp"

namespace hagfish {

/// A growing dataset of whatever type. Rows wait in memory until they are written to the file.
class AnySeries {
 public:
  AnySeries(SeriesLayout layout, std::size_t value_size);
  virtual ~AnySeries() = default;
  AnySeries(const AnySeries&) = delete;
  AnySeries& operator=(const AnySeries&) = delete;

  const SeriesLayout& layout() const { return layout_; }
  /// Creates the dataset in `file`, without rows.
  void create(Hdf5Writer& file) const { file.create(layout_); }
  /// Bytes of one row.
  std::size_t row_bytes() const { return row_size_ * value_size_; }
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
  std::size_t waiting_bytes() const { return (total_ - first_) * row_bytes(); }

 protected:
  virtual const void* waiting() const = 0;
  virtual void keep(std::size_t rows) = 0;  ///< keeps the first rows of those that wait
  std::size_t row_size() const { return row_size_; }
  void count_rows(hsize_t rows) { total_ += rows; }

 private:
  SeriesLayout layout_;
  std::size_t row_size_;    // values
  std::size_t value_size_;  // bytes
  hsize_t first_ = 0;       // rows of the file: those before what waits
  hsize_t total_ = 0;
};

using SeriesList = std::vector<std::shared_ptr<AnySeries>>;

/// The rows of a series of numbers.
template <class T>
class Series final : public AnySeries {
 public:
  explicit Series(SeriesLayout layout) : AnySeries(std::move(layout), sizeof(T)) {}
  /// Appends one row; `count` must be the row's size.
  void append(const T* row, std::size_t count);
  void append(T value) { append(&value, 1); }

 protected:
  const void* waiting() const override { return waiting_.data(); }
  void keep(std::size_t rows) override { waiting_.resize(rows * row_size()); }

 private:
  std::vector<T> waiting_;
};

/// The layout of a series of T, whose rows have `row_shape`; with one row a chunk, where its
/// meaning does not ask for more.
template <class T>
SeriesLayout layout_of(const std::string& path, const std::vector<hsize_t>& row_shape,
                       const Meaning& meaning);

/// Stores a series of T compressed, in chunks of a size that suits that.
template <class T>
void pack(SeriesLayout& layout);

/// uint8 enumeration whose values count up from 0 in the order of `names`.
SeriesLayout layout_of_choices(const std::string& path, const std::vector<std::string>& names,
                               const Meaning& meaning);

}  // namespace hagfish
