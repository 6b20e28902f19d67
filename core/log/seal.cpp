#include "core/log/seal.hpp"

#include <H5Cpp.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <sstream>

#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

/// An identifier of HDF5's, closed with this.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw H5::Exception("seal_of", "cannot be opened");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class Digest {
 public:
  void take(const void* bytes, std::size_t size) {
    // crc32_z() takes no bytes for the beginning.
    if (size > 0) crc_ = crc32_z(crc_, static_cast<const Bytef*>(bytes), size);
  }
  template <class T>
  void number(const T& value) {
    take(&value, sizeof value);
  }
  std::uint32_t value() const { return static_cast<std::uint32_t>(crc_); }

 private:
  uLong crc_ = crc32_z(0, nullptr, 0);
};

using Extent = std::vector<hsize_t>;

Extent extent_of(hid_t space) {
  Extent extent(std::max(H5Sget_simple_extent_ndims(space), 0));
  if (!extent.empty()) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

std::size_t count_of(const Extent& extent) {
  return std::accumulate(extent.begin(), extent.end(), hsize_t{1}, std::multiplies<>());
}

/// What there is of values of `type` and `extent`, which `read` puts into a buffer.
void take_values(hid_t type, const Extent& extent, const std::function<herr_t(void*)>& read,
                 Digest& digest) {
  const std::size_t count = count_of(extent);
  std::vector<char> values(count * H5Tget_size(type));
  if (count == 0) return;
  if (read(values.data()) < 0) throw H5::Exception("seal_of", "cannot be read");
  if (H5Tis_variable_str(type) <= 0) {
    digest.take(values.data(), values.size());
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    char* text = nullptr;
    std::memcpy(&text, values.data() + i * sizeof text, sizeof text);
    if (text != nullptr) digest.take(text, std::strlen(text) + 1);
    H5free_memory(text);
  }
}

/// The chunks of a dataset as they are stored, in their order.
void take_chunks(hid_t set, hid_t made, const Extent& extent, std::vector<char>& stored,
                 Digest& digest) {
  Extent chunk(extent.size());
  H5Pget_chunk(made, static_cast<int>(chunk.size()), chunk.data());
  if (count_of(extent) == 0) return;
  Extent offset(extent.size(), 0);
  for (std::size_t axis = 0; axis < extent.size();) {
    hsize_t size = 0;
    if (H5Dget_chunk_storage_size(set, offset.data(), &size) >= 0 && size > 0) {
      if (stored.size() < size) stored.resize(size);
      std::uint32_t filters = 0;
      if (H5Dread_chunk(set, H5P_DEFAULT, offset.data(), &filters, stored.data()) < 0) {
        throw H5::Exception("seal_of", "a chunk cannot be read");
      }
      for (const hsize_t place : offset) digest.number(place);
      digest.take(stored.data(), size);
    }
    for (axis = 0; axis < extent.size(); ++axis) {
      offset[axis] += chunk[axis];
      if (offset[axis] < extent[axis]) break;
      offset[axis] = 0;
    }
  }
}

/// Class and size of the values, and how many there are.
void take_form(hid_t type, const Extent& extent, Digest& digest) {
  digest.number(static_cast<int>(H5Tget_class(type)));
  digest.number(std::uint64_t{H5Tget_size(type)});
  for (const hsize_t length : extent) digest.number(length);
}

std::uint32_t digest_of_set(hid_t set, std::vector<char>& storage) {
  const Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose),
      made(H5Dget_create_plist(set), H5Pclose);
  const Extent extent = extent_of(space);
  Digest digest;
  take_form(type, extent, digest);
  if (H5Pget_layout(made) == H5D_CHUNKED) {
    take_chunks(set, made, extent, storage, digest);
  } else {
    take_values(
        type, extent,
        [&](void* values) { return H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values); },
        digest);
  }
  return digest.value();
}

std::uint32_t digest_of_attribute(hid_t attribute) {
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  const Extent extent = extent_of(space);
  Digest digest;
  take_form(type, extent, digest);
  take_values(
      type, extent, [&](void* values) { return H5Aread(attribute, type, values); }, digest);
  return digest.value();
}

struct Place {
  std::string path;
  Seal* seal;
  std::vector<char>* storage;
};

herr_t see_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/, void* data) try {
  const Place& at = *static_cast<Place*>(data);
  for (const char* labels : {"DIMENSION_LIST", "REFERENCE_LIST"}) {
    if (std::strcmp(name, labels) == 0) return 0;
  }
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  at.seal->emplace(fmt::format("{}: attribute {}", at.path, name), digest_of_attribute(attribute));
  return 0;
} catch (const H5::Exception&) {
  return -1;
}

void see_attributes(hid_t object, Place at) {
  if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, see_attribute, &at) < 0) {
    throw H5::Exception("seal_of", "attributes cannot be read");
  }
}

herr_t see_member(hid_t group, const char* name, const H5L_info_t* link, void* data) try {
  const Place& in = *static_cast<Place*>(data);
  const Place at{in.path + "/" + name, in.seal, in.storage};
  if (at.path == seal_path) return 0;
  if (link->type != H5L_TYPE_HARD) {
    at.seal->emplace(at.path, 0);
    return 0;
  }
  const Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (H5Iget_type(object) == H5I_DATASET) {
    at.seal->emplace(at.path, digest_of_set(object, *at.storage));
  }
  see_attributes(object, at);
  if (H5Iget_type(object) != H5I_GROUP) return 0;
  Place within = at;
  return H5Literate(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, see_member, &within);
} catch (const H5::Exception&) {
  return -1;
}

}  // namespace

Seal seal_of(hid_t object) {
  Seal seal;
  std::vector<char> storage;
  const Handle file(H5Iget_file_id(object), H5Fclose),
      root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  see_attributes(root, {"/", &seal, &storage});
  Place at{"", &seal, &storage};
  if (H5Literate(root, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, see_member, &at) < 0) {
    throw H5::Exception("seal_of", "a dataset cannot be read");
  }
  return seal;
}

void seal_file(const std::filesystem::path& file) {
  guarded(file.string(), "seal", [&] {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
    type.setCset(H5T_CSET_UTF8);
    h5.createDataSet(seal_path, type, H5::DataSpace(H5S_SCALAR))
        .write(seal_text(seal_of(h5.getId())), type);
  });
}

void unseal_file(const std::filesystem::path& file) {
  guarded(file.string(), "unseal", [&] {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    if (h5.nameExists(seal_path)) h5.unlink(seal_path);
  });
}

std::string seal_text(const Seal& seal) {
  std::string text;
  for (const auto& [name, digest] : seal) text += fmt::format("{:08x} {}\n", digest, name);
  return text;
}

Seal read_seal(const std::string& text) {
  Seal seal;
  std::istringstream lines(text);
  std::uint32_t digest = 0;
  std::string name;
  while (lines >> std::hex >> digest && lines.get() == ' ' && std::getline(lines, name)) {
    seal.emplace(name, digest);
  }
  return seal;
}

std::vector<std::string> changes(const Seal& then, const Seal& now) {
  std::vector<std::string> names;
  for (const auto& [name, digest] : then) {
    const auto found = now.find(name);
    if (found == now.end()) {
      names.push_back(name + " is gone");
    } else if (found->second != digest) {
      names.push_back(name + " is changed");
    }
  }
  for (const auto& [name, digest] : now) {
    if (!then.contains(name)) names.push_back(name + " is new");
  }
  return names;
}

}  // namespace hagfish
