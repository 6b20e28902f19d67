// What writing a log needs of HDF5: attributes, arrays, texts, series that grow by rows.
#pragma once

#include <H5Cpp.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/log/hdf5_error.hpp"

namespace hagfish {

/// Unit and meaning that go with every numeric dataset; unit "1" where there is none.
struct Meaning {
  std::string unit;
  std::string description;
  bool sparse = false;  ///< mostly zeros, which are worth compressing; motion is not
};

/// A dataset with rows of fixed shape, chunked and extensible along the rows. Rows are gathered and
/// written a chunk at a time, so that compression works on whole chunks; flush() writes the rest.
template <class T>
class Series {
 public:
  Series() = default;
  Series(const H5::DataSet& set, std::vector<hsize_t> row_shape);
  /// Appends one row; `count` must be the row's size.
  void append(const T* row, std::size_t count);
  void append(T value) { append(&value, 1); }
  void flush();

 private:
  H5::DataSet set_;
  std::vector<hsize_t> row_shape_;
  std::size_t row_size_ = 0;
  hsize_t written_ = 0;
  std::vector<T> waiting_;
};

/// A file being written. It grows in memory, where HDF5 cannot fail half-way: on a full disk HDF5
/// can neither close nor abandon a file. save() puts a whole and readable file on disk.
class Hdf5Writer {
 public:
  Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& path);
  void root_attribute(const std::string& name, const std::string& value);
  void root_attribute(const std::string& name, int value);
  void numbers(const std::string& path, const Eigen::VectorXd& values, const Meaning& meaning);
  /// The same without unit and meaning, where a file's thousands of datasets share theirs.
  void plain(const std::string& path, const Eigen::VectorXd& values);
  void plain(const std::string& path, const Eigen::MatrixXd& values);
  /// Of a group.
  void attribute(const std::string& path, const std::string& name, std::int64_t value);
  void text(const std::string& path, const std::string& value);
  void texts(const std::string& path, const std::vector<std::string>& values);

  Series<double> doubles(const std::string& path, const std::vector<hsize_t>& row_shape,
                         const Meaning& meaning);
  Series<std::int32_t> ints(const std::string& path, const std::vector<hsize_t>& row_shape,
                            const Meaning& meaning);
  Series<std::int64_t> longs(const std::string& path, const Meaning& meaning);
  /// uint8 enumeration whose values count up from 0 in the order of `names`.
  Series<std::uint8_t> choices(const std::string& path, const std::vector<std::string>& names,
                               const Meaning& meaning);

  /// Writes all of it to `file`, by way of a second file, so that a crash leaves the last one
  /// saved.
  void save(const std::filesystem::path& file) const;

 private:
  H5::DataSet series(const std::string& path, const H5::DataType& type,
                     const std::vector<hsize_t>& row_shape, const Meaning& meaning);
  H5::H5File h5_;
};

}  // namespace hagfish
