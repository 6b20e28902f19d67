// Reading logs and other HDF5, of any origin. Every failure is thrown as FileError in one line that
// names the file. Nothing is read but what the file itself holds: links, and datasets whose numbers
// are in other files, are refused; so are datasets that say they hold more than the file can,
// before memory is asked for.
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

/// Who wrote a file. What this process wrote just now is read as it is, all else as a copy of it
/// (hdf5_copy.hpp).
enum class Origin { anywhere, own };

/// A file being read.
class Hdf5Reader {
 public:
  /// Throws FileError where the file is missing, not a regular one, unreadable, not HDF5, or such
  /// that HDF5 crashes on it or comes to no end (hdf5_copy.hpp).
  explicit Hdf5Reader(const std::filesystem::path& file, Origin origin = Origin::anywhere);
  bool has(const std::string& path) const;
  /// Attributes of the file: one text, one whole number.
  std::string root_text(const std::string& name) const;
  bool has_root_attribute(const std::string& name) const;
  int root_int(const std::string& name) const;
  /// A whole number that goes with a group; none where there is no such attribute.
  std::optional<std::int64_t> attribute_int(const std::string& group,
                                            const std::string& name) const;
  /// Extents of a dataset; none of a single value.
  std::vector<hsize_t> shape(const std::string& path) const;
  /// What the values of a dataset are.
  H5T_class_t type(const std::string& path) const;
  /// A dataset's attribute, one text.
  std::string attribute(const std::string& path, const std::string& name) const;
  /// All values, row by row.
  std::vector<double> doubles(const std::string& path) const;
  std::vector<std::int64_t> integers(const std::string& path) const;
  std::vector<std::uint8_t> bytes(const std::string& path) const;
  std::vector<std::string> texts(const std::string& path) const;
  std::string text(const std::string& path) const;  ///< of a dataset that holds one
  /// Names of what lies in a group, in order.
  std::vector<std::string> names(const std::string& group) const;
  /// Rows as a matrix, rows x (product of the other extents).
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows rows(const std::string& path) const;
  /// Throws FileError where there is none.
  H5::DataSet open(const std::string& path) const;
  const std::string& file() const { return file_; }
  /// Writes what is read to a file of another name. Throws FileError where that cannot be written.
  void write_to(const std::filesystem::path& file) const;

 private:
  bool holds(const std::string& path) const;
  void require_group(const std::string& path) const;
  std::string file_;
  std::uintmax_t file_size_ = 0;  // bytes
  H5::H5File h5_;
};

}  // namespace hagfish
