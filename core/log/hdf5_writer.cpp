#include "core/log/hdf5_writer.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>

namespace hagfish {
namespace {

// Higher levels take up to twice as long and gain nothing on forces.
constexpr int deflate_level = 1;
// In which bytes without rows are stored.
constexpr hsize_t bytes_chunk = 16384;
// By which the file grows in memory, bytes.
constexpr std::size_t memory_increment = std::size_t{1} << 16;

bool all_zero(const char* bytes, std::size_t count) {
  return count == 0 || (bytes[0] == 0 && std::memcmp(bytes, bytes + 1, count - 1) == 0);
}

H5::StrType text_type() {
  H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
  type.setCset(H5T_CSET_UTF8);
  return type;
}

void text_attribute(H5::H5Object& object, const std::string& name, const std::string& value) {
  if (object.attrExists(name)) {
    object.removeAttr(name);
  }
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
  guarded(name_, "open", [&] { h5_ = H5::H5File(name_, H5F_ACC_RDWR); });
}

Hdf5Writer::Hdf5Writer() : name_("file in memory") {
  H5::Exception::dontPrint();
  guarded(name_, "begin", [&] {
    H5::FileAccPropList in_memory;
    in_memory.setCore(memory_increment, false);
    h5_ = H5::H5File("log", H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
  });
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
  guarded(name_, "write " + path, [&] {
    const hsize_t size = values.size();
    H5::DataSet set = h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, &size));
    set.write(values.data(), H5::PredType::NATIVE_DOUBLE);
    describe(set, meaning);
  });
}

void Hdf5Writer::plain(const std::string& path, const Eigen::VectorXd& values) {
  guarded(name_, "write " + path, [&] {
    const hsize_t size = values.size();
    h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, &size))
        .write(values.data(), H5::PredType::NATIVE_DOUBLE);
  });
}

void Hdf5Writer::plain(const std::string& path, const Eigen::MatrixXd& values) {
  guarded(name_, "write " + path, [&] {
    const std::array<hsize_t, 2> shape{static_cast<hsize_t>(values.rows()),
                                       static_cast<hsize_t>(values.cols())};
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_rows = values;
    h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(2, shape.data()))
        .write(by_rows.data(), H5::PredType::NATIVE_DOUBLE);
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
    h5_.createDataSet(path, text_type(), H5::DataSpace(H5S_SCALAR)).write(value, text_type());
  });
}

void Hdf5Writer::texts(const std::string& path, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  for (const std::string& value : values) {
    pointers.push_back(value.c_str());
  }
  guarded(name_, "write " + path, [&] {
    const hsize_t size = values.size();
    h5_.createDataSet(path, text_type(), H5::DataSpace(1, &size))
        .write(pointers.data(), text_type());
  });
}

void Hdf5Writer::bytes(const std::string& path, const std::vector<std::uint8_t>& values,
                       const std::string& description) {
  const hsize_t size = values.size();
  guarded(name_, "write " + path, [&] {
    if (!h5_.nameExists(path)) {
      const hsize_t most = H5S_UNLIMITED;
      H5::DSetCreatPropList storage;
      storage.setChunk(1, &bytes_chunk);
      storage.setFletcher32();
      H5::DataSet created = h5_.createDataSet(path, H5::PredType::NATIVE_UINT8,
                                              H5::DataSpace(1, &size, &most), storage);
      describe(created, {"1", description});
    }
    H5::DataSet set = h5_.openDataSet(path);
    set.extend(&size);
    set.write(values.data(), H5::PredType::NATIVE_UINT8);
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
      const H5::DataSet scale = h5_.openDataSet(labels[axis]);
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
  const std::vector<hsize_t> chunk = layout.shape(layout.chunk_rows);
  guarded(name_, "create " + layout.path, [&] {
    H5::DSetCreatPropList storage;
    storage.setChunk(static_cast<int>(chunk.size()), chunk.data());
    if (layout.meaning.packed) {
      storage.setShuffle();
      storage.setDeflate(deflate_level);
    }
    storage.setFletcher32();  // readers refuse a chunk with a flipped bit
    H5::LinkCreatPropList groups;
    groups.setCreateIntermediateGroup(true);
    H5::DataSet set =
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

void Hdf5Writer::append(const SeriesLayout& layout, hsize_t first, hsize_t count,
                        const void* values) {
  const hsize_t end = first + count;
  const std::vector<hsize_t> extent = layout.shape(end);
  const hsize_t row_bytes =
      std::accumulate(layout.row_shape.begin(), layout.row_shape.end(),
                      static_cast<hsize_t>(layout.type.getSize()), std::multiplies<>());
  const auto row = [&](hsize_t i) {
    return static_cast<const char*>(values) + (i - first) * row_bytes;
  };
  guarded(name_, "write " + layout.path, [&] {
    H5::DataSet set = h5_.openDataSet(layout.path);
    set.extend(extent.data());
    const H5::DataSpace space = set.getSpace();
    const auto write = [&](hsize_t from, hsize_t to) {
      const std::vector<hsize_t> size = layout.shape(to - from);
      std::vector<hsize_t> offset(size.size(), 0);
      offset[0] = from;
      space.selectHyperslab(H5S_SELECT_SET, size.data(), offset.data());
      set.write(row(from), layout.type, H5::DataSpace(static_cast<int>(size.size()), size.data()),
                space);
    };
    // Rows without a chunk of their own read as 0: most forces are 0 for whole phases.
    hsize_t from = first;
    for (hsize_t at = first; at < end;) {
      const hsize_t next = std::min(end, (at / layout.chunk_rows + 1) * layout.chunk_rows);
      if (all_zero(row(at), (next - at) * row_bytes)) {
        if (from < at) write(from, at);
        from = next;
      }
      at = next;
    }
    if (from < end) write(from, end);
  });
}

void Hdf5Writer::copy_chunks(const Hdf5Reader& from, const SeriesLayout& layout, hsize_t begin,
                             hsize_t end) {
  const std::vector<hsize_t> extent = layout.shape(end * layout.chunk_rows);
  guarded(name_, "write " + layout.path, [&] {
    const H5::DataSet source = from.open(layout.path);
    const H5::DataSet target = h5_.openDataSet(layout.path);
    target.extend(extent.data());
    std::vector<hsize_t> offset(extent.size(), 0);
    std::vector<char> stored;
    for (hsize_t chunk = begin; chunk < end; ++chunk) {
      offset[0] = chunk * layout.chunk_rows;
      hsize_t size = 0;
      haddr_t place = HADDR_UNDEF;
      unsigned skipped = 0;  // filters
      std::uint32_t filters = 0;
      bool done =
          H5Dget_chunk_info_by_coord(source.getId(), offset.data(), &skipped, &place, &size) >= 0;
      if (done && place == HADDR_UNDEF) continue;  // all of it is 0
      stored.resize(size);
      done =
          done &&
          H5Dread_chunk(source.getId(), H5P_DEFAULT, offset.data(), &filters, stored.data()) >= 0 &&
          H5Dwrite_chunk(target.getId(), H5P_DEFAULT, filters, offset.data(), size,
                         stored.data()) >= 0;
      if (!done) {
        throw H5::DataSetIException("copy_chunks", "a chunk cannot be copied");
      }
    }
  });
}

void Hdf5Writer::close() {
  guarded(name_, "save", [&] { h5_.close(); });
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
    throw FileError(file.string() + ": cannot be " + what + ": " + reason);
  };
  errno = 0;
  std::ofstream stream(fresh, std::ios::binary);
  if (!stream) {
    fail("created");
  }
  stream.write(image.data(), static_cast<std::streamsize>(image.size()));
  stream.close();
  if (!stream) {
    fail("written");
  }
  std::error_code error;
  std::filesystem::rename(fresh, file, error);
  if (error) {
    errno = error.value();
    fail("given its name");
  }
}

}  // namespace hagfish
