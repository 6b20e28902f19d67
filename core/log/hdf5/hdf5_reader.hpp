// Reading logs and other HDF5, of any origin. Every failure is thrown as FileError in one line that
// names the file. Nothing is read but what the file itself holds: links, and datasets whose numbers
// are in other files, are refused; so are datasets that say they hold more than the file can,
// before memory is asked for. HDF5 1.10 crashes on some damaged files and comes to no end on
// others: commands read foreign files in a process of their own, which SIGVTALRM ends in time.
#pragma once

#include <H5Cpp.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {

/// A file being read.
class Hdf5Reader {
 public:
  /// Throws FileError where the file is missing, not a regular one, unreadable or not HDF5.
  explicit Hdf5Reader(const std::filesystem::path& file);
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
  std::vector<std::string> texts(const std::string& path) const;
  std::string text(const std::string& path) const;  ///< text of a dataset that holds one
  /// What a dataset says of itself, by name: its attributes, its type, and the labels of its axes.
  std::map<std::string, std::string> words(const std::string& path) const;
  /// Paths of all datasets.
  std::vector<std::string> datasets() const;
  /// Names of what lies in a group, in order.
  std::vector<std::string> names(const std::string& group) const;
  /// Rows as a matrix, rows x (product of the other extents).
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows rows(const std::string& path) const;
  /// Throws FileError where there is none.
  H5::DataSet open(const std::string& path) const;
  const std::string& file() const { return file_; }

 private:
  template <class Work>
  auto reading(const std::string& what, Work&& work) const;
  bool holds(const std::string& path) const;
  void require_group(const std::string& path) const;
  void add_datasets(const std::string& group, std::vector<std::string>& paths) const;
  std::string file_;
  std::uintmax_t file_size_ = 0;  // bytes
  H5::H5File h5_;
};

}  // namespace hagfish
