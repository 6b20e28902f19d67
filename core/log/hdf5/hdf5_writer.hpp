// What writing a log needs of HDF5: attributes, arrays, texts, series that grow by rows.
#pragma once

#include <H5Cpp.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {

/// How a series is stored. Chunks of zeros take no room in any of them.
enum class Storage : std::uint8_t {
  rows,    ///< chunks of whole rows
  blocks,  ///< chunks of some columns: mostly zeros, as forces that act on a part of the body
  packed   ///< compressed, at a price in CPU time: alike in time
};

/// Unit and meaning that go with every numeric dataset; unit "1" where there is none.
struct Meaning {
  std::string unit;
  std::string description;
  Storage storage = Storage::rows;
};

/// An axis of a dataset: its extent, and the path of the dataset that labels it (its dimension
/// scale), empty where nothing does.
struct LabelledAxis {
  hsize_t size = 0;
  std::string labels;
};

/// A dataset that grows by rows of fixed shape: stored in chunks with a checksum each.
struct SeriesLayout {
  std::string path;
  std::vector<hsize_t> row_shape;
  Meaning meaning;
  H5::DataType type;
  hsize_t chunk_rows = 1;
  hsize_t chunk_columns = 0;  ///< columns of a chunk along the last axis; 0: all of them
  bool single = false;        ///< doubles are stored as floats
  double resolution = 0;      ///< doubles are rounded to multiples of it; 0 for none
  std::vector<std::string>
      labels;  ///< labels of each axis, as LabelledAxis::labels; none where nothing does

  /// Extents of so many rows.
  std::vector<hsize_t> shape(hsize_t rows) const {
    std::vector<hsize_t> extent{rows};
    extent.insert(extent.end(), row_shape.begin(), row_shape.end());
    return extent;
  }
  /// Extents of so many rows, `columns` wide; 0: all of them.
  std::vector<hsize_t> shape(hsize_t rows, hsize_t columns) const {
    std::vector<hsize_t> extent = shape(rows);
    if (columns > 0) extent.back() = columns;
    return extent;
  }
};

/// A file being written.
class Hdf5Writer {
 public:
  /// A new one. It grows in memory, where HDF5 cannot fail half-way: on a full disk HDF5 can
  /// neither close nor abandon a file. save() puts a whole and readable file on disk.
  Hdf5Writer();
  /// One that is there, to be changed on the disk, which must have room.
  explicit Hdf5Writer(const std::filesystem::path& file);
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& path);
  void root_attribute(const std::string& name, const std::string& value);
  void root_attribute(const std::string& name, int value);
  void numbers(const std::string& path, const Eigen::VectorXd& values, const Meaning& meaning);
  /// Writes numbers without unit and meaning, where a file's thousands of datasets share theirs.
  void plain(const std::string& path, const Eigen::VectorXd& values);
  void plain(const std::string& path, const Eigen::MatrixXd& values);
  /// Attribute of a group.
  void attribute(const std::string& path, const std::string& name, std::int64_t value);
  void text(const std::string& path, const std::string& value);
  void texts(const std::string& path, const std::vector<std::string>& values);

  /// Makes a dataset the labels of others' axes (a dimension scale), by the last part of its path.
  void make_labels(const std::string& path);
  /// Labels the axes of a dataset, in their order; an empty text leaves one as it is. In the
  /// dataset's group the labels get their own name again, by which netCDF's readers find them.
  void label(const std::string& path, const std::vector<std::string>& labels);

  /// A series without rows, in groups that are created with it.
  void create(const SeriesLayout& layout);
  /// Sets rows `first` on of a series, and no others behind them, from `count` rows of values.
  void append(const SeriesLayout& layout, hsize_t first, hsize_t count, const void* values);
  /// Closes a file on the disk. Throws FileError where that fails, after which it is of no use.
  void close();

  /// Writes all of it to `file`, by way of a second file, so that a crash leaves the last one
  /// saved. Only of a new file. Throws WriteError where the disk is full.
  void save(const std::filesystem::path& file) const;

 private:
  /// The dataset, opened unless it is open.
  H5::DataSet& dataset(const std::string& path);
  void write_doubles(const std::string& path, const std::vector<hsize_t>& shape,
                     const double* values);

  std::string name_;  // name in messages
  H5::H5File h5_;
  // Datasets to be labelled, by path: opening them anew for each label took a fifth of a log's
  // creation. Rows are written to one opened for it, as closing gives its chunks' cache back.
  std::unordered_map<std::string, H5::DataSet> open_;
};

}  // namespace hagfish
