#include "core/log/hdf5/hdf5_writer.hpp"

#include <hdf5_hl.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace hagfish {
namespace {

// Higher levels take up to twice as long and gain nothing.
constexpr int deflate_level = 1;
// By which the file grows in memory, bytes.
constexpr std::size_t memory_increment = std::size_t{1} << 16;
// In which texts are converted, bytes; HDF5's own, of 1 MB, is cleared for each of them.
constexpr std::size_t text_buffer = 4096;

H5::StrType text_type() {
  H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
  type.setCset(H5T_CSET_UTF8);
  return type;
}

H5::DSetMemXferPropList text_transfer() {
  H5::DSetMemXferPropList transfer;
  transfer.setBuffer(text_buffer, nullptr, nullptr);
  return transfer;
}

void text_attribute(H5::H5Object& object, const std::string& name, const std::string& value) {
  if (object.attrExists(name)) object.removeAttr(name);
  object.createAttribute(name, text_type(), H5::DataSpace(H5S_SCALAR)).write(text_type(), value);
}

/// The last part of a path.
std::string name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

void describe(H5::DataSet& set, const Meaning& meaning) {
  text_attribute(set, "unit", meaning.unit);
  text_attribute(set, "description", meaning.description);
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file) : name_(file.string()) {
  H5::Exception::dontPrint();
  guarded(name_, "open", [&] {
    h5_ = H5::H5File(name_, H5F_ACC_RDWR, H5::FileCreatPropList::DEFAULT, without_locks());
  });
}

Hdf5Writer::Hdf5Writer() : name_("file in memory") {
  H5::Exception::dontPrint();
  guarded(name_, "begin", [&] {
    H5::FileAccPropList in_memory;
    in_memory.setCore(memory_increment, false);
    h5_ = H5::H5File("log", H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
  });
}

H5::DataSet& Hdf5Writer::dataset(const std::string& path) {
  const auto known = open_.find(path);
  return known != open_.end() ? known->second
                              : open_.emplace(path, h5_.openDataSet(path)).first->second;
}

void Hdf5Writer::group(const std::string& path) {
  guarded(name_, "create " + path, [&] { h5_.createGroup(path); });
}

void Hdf5Writer::root_attribute(const std::string& name, const std::string& value) {
  guarded(name_, "write attribute " + name, [&] {
    H5::Group root = h5_.openGroup("/");
    text_attribute(root, name, value);
  });
}

void Hdf5Writer::root_attribute(const std::string& name, int value) {
  guarded(name_, "write attribute " + name, [&] {
    h5_.openGroup("/")
        .createAttribute(name, H5::PredType::NATIVE_INT32, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT, &value);
  });
}

void Hdf5Writer::numbers(const std::string& path, const Eigen::VectorXd& values,
                         const Meaning& meaning) {
  plain(path, values);
  guarded(name_, "write " + path, [&] {
    H5::DataSet set = h5_.openDataSet(path);
    describe(set, meaning);
  });
}

void Hdf5Writer::plain(const std::string& path, const Eigen::VectorXd& values) {
  write_doubles(path, {static_cast<hsize_t>(values.size())}, values.data());
}

void Hdf5Writer::plain(const std::string& path, const Eigen::MatrixXd& values) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_rows = values;
  write_doubles(path, {static_cast<hsize_t>(values.rows()), static_cast<hsize_t>(values.cols())},
                by_rows.data());
}

void Hdf5Writer::write_doubles(const std::string& path, const std::vector<hsize_t>& shape,
                               const double* values) {
  guarded(name_, "write " + path, [&] {
    const H5::DataSpace space(static_cast<int>(shape.size()), shape.data());
    h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, space)
        .write(values, H5::PredType::NATIVE_DOUBLE);
  });
}

void Hdf5Writer::attribute(const std::string& path, const std::string& name, std::int64_t value) {
  guarded(name_, "write attribute " + name + " of " + path, [&] {
    h5_.openGroup(path)
        .createAttribute(name, H5::PredType::NATIVE_INT64, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT64, &value);
  });
}

void Hdf5Writer::text(const std::string& path, const std::string& value) {
  guarded(name_, "write " + path, [&] {
    h5_.createDataSet(path, text_type(), H5::DataSpace(H5S_SCALAR))
        .write(value, text_type(), H5::DataSpace::ALL, H5::DataSpace::ALL, text_transfer());
  });
}

void Hdf5Writer::texts(const std::string& path, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  guarded(name_, "write " + path, [&] {
    const hsize_t size = values.size();
    h5_.createDataSet(path, text_type(), H5::DataSpace(1, &size))
        .write(static_cast<const void*>(pointers.data()), text_type(), H5::DataSpace::ALL,
               H5::DataSpace::ALL, text_transfer());
  });
}

void Hdf5Writer::make_labels(const std::string& path) {
  guarded(name_, "make labels of " + path, [&] {
    const H5::DataSet set = h5_.openDataSet(path);
    if (H5DSset_scale(set.getId(), name_of(path).c_str()) < 0) {
      throw H5::DataSetIException("H5DSset_scale", "no scale");
    }
  });
}

void Hdf5Writer::label(const std::string& path, const std::vector<std::string>& labels) {
  guarded(name_, "label " + path, [&] {
    const H5::DataSet set = h5_.openDataSet(path);
    for (std::size_t axis = 0; axis < labels.size(); ++axis) {
      // Labels label themselves.
      if (labels[axis].empty() || labels[axis] == path) continue;
      const H5::DataSet& scale = dataset(labels[axis]);
      if (H5DSattach_scale(set.getId(), scale.getId(), static_cast<unsigned>(axis)) < 0) {
        throw H5::DataSetIException("H5DSattach_scale", "not attached");
      }
      const std::string here = path.substr(0, path.rfind('/') + 1) + name_of(labels[axis]);
      if (!h5_.nameExists(here)) h5_.link(labels[axis], here);
    }
  });
}

void Hdf5Writer::create(const SeriesLayout& layout) {
  const std::vector<hsize_t> now = layout.shape(0);
  const std::vector<hsize_t> most = layout.shape(H5S_UNLIMITED);
  const std::vector<hsize_t> chunk = layout.shape(layout.chunk_rows, layout.chunk_columns);
  guarded(name_, "create " + layout.path, [&] {
    H5::DSetCreatPropList storage;
    storage.setChunk(static_cast<int>(chunk.size()), chunk.data());
    if (layout.meaning.storage == Storage::packed) {
      storage.setShuffle();
      storage.setDeflate(deflate_level);
    }
    storage.setFletcher32();  // readers refuse a chunk with a flipped bit
    H5::LinkCreatPropList groups;
    groups.setCreateIntermediateGroup(true);
    H5::DataSet& set = open_[layout.path] =
        h5_.createDataSet(layout.path, layout.single ? H5::PredType::NATIVE_FLOAT : layout.type,
                          H5::DataSpace(static_cast<int>(now.size()), now.data(), most.data()),
                          storage, H5::DSetAccPropList::DEFAULT, groups);
    describe(set, layout.meaning);
    if (layout.resolution > 0) {
      set.createAttribute("resolution", H5::PredType::NATIVE_DOUBLE, H5::DataSpace(H5S_SCALAR))
          .write(H5::PredType::NATIVE_DOUBLE, &layout.resolution);
    }
  });
}

void Hdf5Writer::close() {
  guarded(name_, "save", [&] {
    open_.clear();
    h5_.close();
  });
}

void Hdf5Writer::save(const std::filesystem::path& file) const {
  const std::vector<char> image = guarded(name_, "gather", [&] {
    h5_.flush(H5F_SCOPE_GLOBAL);
    std::vector<char> bytes(static_cast<std::size_t>(h5_.getFileSize()));
    if (H5Fget_file_image(h5_.getId(), bytes.data(), bytes.size()) < 0) {
      throw H5::FileIException("H5Fget_file_image", "no image");
    }
    return bytes;
  });
  const std::filesystem::path fresh = file.string() + ".new";
  const auto fail = [&](const char* what) {
    const std::string reason = std::strerror(errno);
    std::error_code ignored;
    std::filesystem::remove(fresh, ignored);
    throw WriteError(file.string() + ": cannot be " + what + ": " + reason);
  };
  errno = 0;
  std::ofstream stream(fresh, std::ios::binary);
  if (!stream) fail("created");
  stream.write(image.data(), static_cast<std::streamsize>(image.size()));
  stream.close();
  if (!stream) fail("written");
  std::error_code error;
  std::filesystem::rename(fresh, file, error);
  if (error) {
    errno = error.value();
    fail("given its name");
  }
}

}  // namespace hagfish
