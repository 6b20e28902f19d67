#include "core/log/hdf5_reader.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace hagfish {
namespace {

std::size_t size_of(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : file_(file.string()) {
  H5::Exception::dontPrint();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw FileError(file_ + ": no such file");
  }
  guarded(file_, "read as HDF5", [&] { h5_ = H5::H5File(file_, H5F_ACC_RDONLY); });
}

H5::DataSet Hdf5Reader::open(const std::string& path) const {
  if (!has(path)) {
    throw FileError(file_ + ": has no " + path);
  }
  return guarded(file_, "read " + path, [&] { return h5_.openDataSet(path); });
}

bool Hdf5Reader::has(const std::string& path) const {
  return guarded(file_, "look for " + path, [&] { return holds(path); });
}

bool Hdf5Reader::holds(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (!h5_.nameExists(path.substr(0, end))) {
      return false;
    }
    if (end == std::string::npos) {
      return true;
    }
  }
}

std::string Hdf5Reader::root_text(const std::string& name) const {
  return guarded(file_, "read attribute " + name, [&] {
    const H5::Attribute attribute = h5_.openGroup("/").openAttribute(name);
    std::string value;
    attribute.read(attribute.getStrType(), value);
    return value;
  });
}

bool Hdf5Reader::has_root_attribute(const std::string& name) const {
  return guarded(file_, "look for attribute " + name,
                 [&] { return h5_.openGroup("/").attrExists(name); });
}

int Hdf5Reader::root_int(const std::string& name) const {
  return guarded(file_, "read attribute " + name, [&] {
    int value = 0;
    h5_.openGroup("/").openAttribute(name).read(H5::PredType::NATIVE_INT, &value);
    return value;
  });
}

std::optional<std::int64_t> Hdf5Reader::attribute_int(const std::string& group,
                                                      const std::string& name) const {
  return guarded(file_, "read attribute " + name + " of " + group, [&] {
    const H5::Group members = h5_.openGroup(group);
    if (!members.attrExists(name)) {
      return std::optional<std::int64_t>();
    }
    const H5::Attribute attribute = members.openAttribute(name);
    if (attribute.getTypeClass() != H5T_INTEGER ||
        attribute.getSpace().getSimpleExtentNpoints() != 1) {
      throw FileError(file_ + ": attribute " + name + " of " + group + " is not one whole number");
    }
    std::int64_t value = 0;
    attribute.read(H5::PredType::NATIVE_INT64, &value);
    return std::optional<std::int64_t>(value);
  });
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& path) const {
  const H5::DataSet set = open(path);
  return guarded(file_, "read the shape of " + path, [&] {
    const H5::DataSpace space = set.getSpace();
    std::vector<hsize_t> extent(space.getSimpleExtentNdims());
    if (!extent.empty()) {
      space.getSimpleExtentDims(extent.data());
    }
    return extent;
  });
}

std::string Hdf5Reader::attribute(const std::string& path, const std::string& name) const {
  const H5::DataSet set = open(path);
  return guarded(file_, "read attribute " + name + " of " + path, [&] {
    const H5::Attribute attribute = set.openAttribute(name);
    std::string value;
    attribute.read(attribute.getStrType(), value);
    return value;
  });
}

std::vector<double> Hdf5Reader::doubles(const std::string& path) const {
  const H5::DataSet set = open(path);
  const H5T_class_t type = guarded(file_, "read " + path, [&] { return set.getTypeClass(); });
  if (type != H5T_FLOAT && type != H5T_INTEGER) {
    throw FileError(file_ + ": " + path + " does not hold numbers");
  }
  std::vector<double> values(size_of(shape(path)));
  guarded(file_, "read " + path, [&] { set.read(values.data(), H5::PredType::NATIVE_DOUBLE); });
  return values;
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& path) const {
  const H5::DataSet set = open(path);
  std::vector<std::int64_t> values(size_of(shape(path)));
  guarded(file_, "read " + path, [&] {
    if (set.getTypeClass() == H5T_ENUM && set.getDataType().getSize() != 1) {
      throw FileError(file_ + ": " + path + " is not an enumeration of one byte");
    }
    if (set.getTypeClass() == H5T_ENUM) {
      std::vector<std::uint8_t> raw(values.size());
      set.read(raw.data(), set.getDataType());
      std::copy(raw.begin(), raw.end(), values.begin());
    } else {
      set.read(values.data(), H5::PredType::NATIVE_INT64);
    }
  });
  return values;
}

std::vector<std::uint8_t> Hdf5Reader::bytes(const std::string& path) const {
  const H5::DataSet set = open(path);
  std::vector<std::uint8_t> values(size_of(shape(path)));
  guarded(file_, "read " + path, [&] {
    if (!(set.getDataType() == H5::PredType::NATIVE_UINT8)) {
      throw FileError(file_ + ": " + path + " does not hold bytes");
    }
    set.read(values.data(), H5::PredType::NATIVE_UINT8);
  });
  return values;
}

std::vector<std::string> Hdf5Reader::texts(const std::string& path) const {
  const H5::DataSet set = open(path);
  const std::size_t count = size_of(shape(path));
  std::vector<std::string> values;
  guarded(file_, "read " + path, [&] {
    std::vector<char*> raw(count);
    const H5::DataType type = set.getDataType();
    set.read(raw.data(), type);
    values.assign(raw.begin(), raw.end());
    H5::DataSet::vlenReclaim(raw.data(), type, set.getSpace());
  });
  return values;
}

std::vector<std::string> Hdf5Reader::names(const std::string& group) const {
  if (!has(group)) {
    throw FileError(file_ + ": has no " + group);
  }
  return guarded(file_, "list " + group, [&] {
    const H5::Group members = h5_.openGroup(group);
    std::vector<std::string> names;
    for (hsize_t i = 0; i < members.getNumObjs(); ++i) {
      names.push_back(members.getObjnameByIdx(i));
    }
    return names;
  });
}

Hdf5Reader::Rows Hdf5Reader::rows(const std::string& path) const {
  const std::vector<hsize_t> extent = shape(path);
  const std::vector<double> values = doubles(path);
  const auto count = static_cast<Eigen::Index>(extent.empty() ? 1 : extent[0]);
  const auto width = count > 0 ? static_cast<Eigen::Index>(values.size()) / count : 0;
  return Eigen::Map<const Rows>(values.data(), count, width);
}

}  // namespace hagfish
