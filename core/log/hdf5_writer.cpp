#include "core/log/hdf5_writer.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>

namespace hagfish {
namespace {

// Rows a chunk: a second of frames at 50 a second; compression gains little beyond.
constexpr hsize_t chunk_rows = 64;
// Higher levels take up to twice as long and gain nothing on forces.
constexpr int deflate_level = 1;
// By which the file grows in memory, bytes.
constexpr std::size_t memory_increment = std::size_t{1} << 20;

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

void describe(H5::DataSet& set, const Meaning& meaning) {
  text_attribute(set, "unit", meaning.unit);
  text_attribute(set, "description", meaning.description);
}

template <class T>
const H5::PredType& native();
template <>
const H5::PredType& native<double>() {
  return H5::PredType::NATIVE_DOUBLE;
}
template <>
const H5::PredType& native<std::int32_t>() {
  return H5::PredType::NATIVE_INT32;
}
template <>
const H5::PredType& native<std::int64_t>() {
  return H5::PredType::NATIVE_INT64;
}
template <>
const H5::PredType& native<std::uint8_t>() {
  return H5::PredType::NATIVE_UINT8;
}

std::size_t size_of(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

}  // namespace

template <class T>
Series<T>::Series(const H5::DataSet& set, std::vector<hsize_t> row_shape)
    : set_(set), row_shape_(std::move(row_shape)), row_size_(size_of(row_shape_)) {}

template <class T>
void Series<T>::append(const T* row, std::size_t count) {
  if (count != row_size_) {
    throw std::logic_error("log row has the wrong size");
  }
  waiting_.insert(waiting_.end(), row, row + count);
  if (waiting_.size() >= chunk_rows * row_size_) {
    flush();
  }
}

template <class T>
void Series<T>::flush() {
  const hsize_t rows = waiting_.size() / row_size_;
  if (rows == 0) {
    return;
  }
  std::vector<hsize_t> extent{written_ + rows};
  std::vector<hsize_t> count{rows};
  std::vector<hsize_t> offset(row_shape_.size() + 1, 0);
  offset[0] = written_;
  extent.insert(extent.end(), row_shape_.begin(), row_shape_.end());
  count.insert(count.end(), row_shape_.begin(), row_shape_.end());
  guarded("log", "write " + set_.getObjName(), [&] {
    set_.extend(extent.data());
    const H5::DataSpace space = set_.getSpace();
    space.selectHyperslab(H5S_SELECT_SET, count.data(), offset.data());
    // An enumeration is written as itself: its memory is that of its base type.
    const H5::DataType stored = set_.getDataType();
    const H5::DataType type = stored.getClass() == H5T_ENUM ? stored : H5::DataType(native<T>());
    set_.write(waiting_.data(), type, H5::DataSpace(static_cast<int>(count.size()), count.data()),
               space);
  });
  written_ += rows;
  waiting_.clear();
}

template class Series<double>;
template class Series<std::int32_t>;
template class Series<std::int64_t>;
template class Series<std::uint8_t>;

Hdf5Writer::Hdf5Writer() {
  H5::Exception::dontPrint();
  guarded("log", "begin", [&] {
    H5::FileAccPropList in_memory;
    in_memory.setCore(memory_increment, false);
    h5_ = H5::H5File("log", H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
  });
}

void Hdf5Writer::group(const std::string& path) {
  guarded("log", "create " + path, [&] { h5_.createGroup(path); });
}

void Hdf5Writer::root_attribute(const std::string& name, const std::string& value) {
  guarded("log", "write attribute " + name, [&] {
    H5::Group root = h5_.openGroup("/");
    text_attribute(root, name, value);
  });
}

void Hdf5Writer::root_attribute(const std::string& name, int value) {
  guarded("log", "write attribute " + name, [&] {
    h5_.openGroup("/")
        .createAttribute(name, H5::PredType::NATIVE_INT32, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT, &value);
  });
}

void Hdf5Writer::numbers(const std::string& path, const Eigen::VectorXd& values,
                         const Meaning& meaning) {
  guarded("log", "write " + path, [&] {
    const hsize_t size = values.size();
    H5::DataSet set = h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, &size));
    set.write(values.data(), H5::PredType::NATIVE_DOUBLE);
    describe(set, meaning);
  });
}

void Hdf5Writer::plain(const std::string& path, const Eigen::VectorXd& values) {
  guarded("log", "write " + path, [&] {
    const hsize_t size = values.size();
    h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(1, &size))
        .write(values.data(), H5::PredType::NATIVE_DOUBLE);
  });
}

void Hdf5Writer::plain(const std::string& path, const Eigen::MatrixXd& values) {
  guarded("log", "write " + path, [&] {
    const std::array<hsize_t, 2> shape{static_cast<hsize_t>(values.rows()),
                                       static_cast<hsize_t>(values.cols())};
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_rows = values;
    h5_.createDataSet(path, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(2, shape.data()))
        .write(by_rows.data(), H5::PredType::NATIVE_DOUBLE);
  });
}

void Hdf5Writer::attribute(const std::string& path, const std::string& name, std::int64_t value) {
  guarded("log", "write attribute " + name + " of " + path, [&] {
    h5_.openGroup(path)
        .createAttribute(name, H5::PredType::NATIVE_INT64, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT64, &value);
  });
}

void Hdf5Writer::text(const std::string& path, const std::string& value) {
  guarded("log", "write " + path, [&] {
    h5_.createDataSet(path, text_type(), H5::DataSpace(H5S_SCALAR)).write(value, text_type());
  });
}

void Hdf5Writer::texts(const std::string& path, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  for (const std::string& value : values) {
    pointers.push_back(value.c_str());
  }
  guarded("log", "write " + path, [&] {
    const hsize_t size = values.size();
    h5_.createDataSet(path, text_type(), H5::DataSpace(1, &size))
        .write(pointers.data(), text_type());
  });
}

H5::DataSet Hdf5Writer::series(const std::string& path, const H5::DataType& type,
                               const std::vector<hsize_t>& row_shape, const Meaning& meaning) {
  std::vector<hsize_t> now{0};
  std::vector<hsize_t> most{H5S_UNLIMITED};
  std::vector<hsize_t> chunk{chunk_rows};
  for (std::vector<hsize_t>* shape : {&now, &most, &chunk}) {
    shape->insert(shape->end(), row_shape.begin(), row_shape.end());
  }
  return guarded("log", "create " + path, [&] {
    H5::DSetCreatPropList layout;
    layout.setChunk(static_cast<int>(chunk.size()), chunk.data());
    if (meaning.sparse) {
      layout.setShuffle();
      layout.setDeflate(deflate_level);
    }
    layout.setFletcher32();  // readers refuse a chunk with a flipped bit
    H5::DataSet set = h5_.createDataSet(
        path, type, H5::DataSpace(static_cast<int>(now.size()), now.data(), most.data()), layout);
    describe(set, meaning);
    return set;
  });
}

Series<double> Hdf5Writer::doubles(const std::string& path, const std::vector<hsize_t>& row_shape,
                                   const Meaning& meaning) {
  return {series(path, H5::PredType::NATIVE_DOUBLE, row_shape, meaning), row_shape};
}

Series<std::int32_t> Hdf5Writer::ints(const std::string& path,
                                      const std::vector<hsize_t>& row_shape,
                                      const Meaning& meaning) {
  return {series(path, H5::PredType::NATIVE_INT32, row_shape, meaning), row_shape};
}

Series<std::int64_t> Hdf5Writer::longs(const std::string& path, const Meaning& meaning) {
  return {series(path, H5::PredType::NATIVE_INT64, {}, meaning), {}};
}

Series<std::uint8_t> Hdf5Writer::choices(const std::string& path,
                                         const std::vector<std::string>& names,
                                         const Meaning& meaning) {
  H5::EnumType type(H5::PredType::NATIVE_UINT8);
  for (std::size_t k = 0; k < names.size(); ++k) {
    auto value = static_cast<std::uint8_t>(k);
    type.insert(names[k], &value);
  }
  return {series(path, type, {}, meaning), {}};
}

void Hdf5Writer::save(const std::filesystem::path& file) const {
  const std::vector<char> image = guarded("log", "gather", [&] {
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
