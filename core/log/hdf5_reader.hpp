// Reading logs and other HDF5. Every failure is thrown as FileError in one line that names the
// file.
#pragma once

#include <H5Cpp.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/log/hdf5_error.hpp"

namespace hagfish {

/// A file being read.
class Hdf5Reader {
 public:
  /// Throws FileError where the file is missing, unreadable or not HDF5.
  explicit Hdf5Reader(const std::filesystem::path& file);
  bool has(const std::string& path) const;
  std::string root_text(const std::string& name) const;
  bool has_root_attribute(const std::string& name) const;
  int root_int(const std::string& name) const;
  /// A whole number that goes with a group; none where there is no such attribute.
  std::optional<std::int64_t> attribute_int(const std::string& group,
                                            const std::string& name) const;
  std::vector<hsize_t> shape(const std::string& path) const;
  std::string attribute(const std::string& path, const std::string& name) const;
  /// All values, row by row.
  std::vector<double> doubles(const std::string& path) const;
  std::vector<std::int64_t> integers(const std::string& path) const;
  std::vector<std::uint8_t> bytes(const std::string& path) const;
  std::vector<std::string> texts(const std::string& path) const;
  /// Names of what lies in a group, in order.
  std::vector<std::string> names(const std::string& group) const;
  /// Rows as a matrix, rows x (product of the other extents).
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows rows(const std::string& path) const;
  /// Throws FileError where there is none.
  H5::DataSet open(const std::string& path) const;
  const std::string& file() const { return file_; }

 private:
  bool holds(const std::string& path) const;
  std::string file_;
  H5::H5File h5_;
};

}  // namespace hagfish
