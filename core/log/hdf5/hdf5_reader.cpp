#include "core/log/hdf5/hdf5_reader.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "core/input/files/text_file.hpp"

namespace hagfish {
namespace {

/// Objects of a group: a set of QPs has one a step.
constexpr hsize_t most_names = 10'000'000;

/// Groups within groups that are looked into; the project's own have two.
constexpr int deepest_group = 8;
/// Deflate packs no better, to one byte of so many; a dataset with more holds what is not in its
/// file.
constexpr hsize_t densest_packing = 1032;
/// But a small one may leave all to its fill value, bytes.
constexpr hsize_t small_dataset = hsize_t{1} << 20;
// HDF5 comes to no end on some damaged files. One call may take so much CPU time, s, and one more
// for each so many bytes; a log of 10 MB takes 0.02 s, a set of 10,000 QPs 1 s.
constexpr double least_time = 2;
constexpr double bytes_each_second = 2e7;

/// Ends the process by SIGVTALRM where this thread takes more CPU time than `seconds`.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) {
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGVTALRM;
    made_ = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
    const itimerspec end{{}, {static_cast<time_t>(std::ceil(seconds)), 0}};
    if (made_) timer_settime(timer_, 0, &end, nullptr);
  }
  ~TimeLimit() {
    if (made_) timer_delete(timer_);
  }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  timer_t timer_{};
  bool made_ = false;
};

/// The type of a dataset's values, in words.
std::string type_text(const H5::DataSet& set) {
  const H5::DataType type = set.getDataType();
  std::string text =
      fmt::format("class {}, {} bytes", static_cast<int>(type.getClass()), type.getSize());
  for (int k = 0; type.getClass() == H5T_ENUM && k < H5Tget_nmembers(type.getId()); ++k) {
    char* const name = H5Tget_member_name(type.getId(), static_cast<unsigned>(k));
    text += fmt::format(", {}", name);
    H5free_memory(name);
  }
  return text;
}

/// Notes the name of a label of an axis.
herr_t note_label(hid_t /*set*/, unsigned /*axis*/, hid_t scale, void* names) {
  constexpr std::size_t longest = 200;
  std::array<char, longest> name{};
  H5DSget_scale_name(scale, name.data(), name.size());
  *static_cast<std::string*>(names) += name.data();
  return 0;
}

/// Whether a dataset of `extent` elements of `size` bytes says that it holds more than a file of
/// `file_size` bytes can. A quantity that does not fit comes out as the largest.
bool exceeds_file(const std::vector<hsize_t>& extent, std::size_t size, hsize_t file_size) {
  hsize_t bytes = size;
  for (const hsize_t length : extent) {
    const bool fits = length == 0 || bytes <= std::numeric_limits<hsize_t>::max() / length;
    bytes = fits ? bytes * length : std::numeric_limits<hsize_t>::max();
  }
  return bytes > std::max(small_dataset, densest_packing * file_size);
}

/// Number of elements of a dataset that does not exceed its file.
hsize_t size_of(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

std::vector<hsize_t> extent_of(const H5::DataSpace& space) {
  std::vector<hsize_t> extent(space.getSimpleExtentNdims());
  if (!extent.empty()) space.getSimpleExtentDims(extent.data());
  return extent;
}

/// A text of fixed length up to the padding after it.
std::string unpadded(const char* text, std::size_t size, H5T_str_t padding) {
  std::string value(text, size);
  const std::size_t end =
      padding == H5T_STR_SPACEPAD ? value.find_last_not_of(' ') + 1 : value.find('\0');
  return value.substr(0, end);
}

/// The one text or whole number of `attribute`; a FileError says what it is if not that.
std::string text_of(const H5::Attribute& attribute, const std::string& name) {
  if (attribute.getTypeClass() != H5T_STRING ||
      attribute.getSpace().getSimpleExtentNpoints() != 1) {
    throw FileError(name + " is not one text");
  }
  const H5::StrType type = attribute.getStrType();
  if (!type.isVariableStr()) {
    std::vector<char> raw(type.getSize());
    attribute.read(type, raw.data());
    return unpadded(raw.data(), raw.size(), type.getStrpad());
  }
  char* raw = nullptr;
  attribute.read(type, static_cast<void*>(&raw));
  std::string value = raw != nullptr ? raw : "";
  H5::DataSet::vlenReclaim(static_cast<void*>(&raw), type, attribute.getSpace());
  return value;
}

std::int64_t whole_number_of(const H5::Attribute& attribute, const std::string& name) {
  if (attribute.getTypeClass() != H5T_INTEGER ||
      attribute.getSpace().getSimpleExtentNpoints() != 1) {
    throw FileError(name + " is not one whole number");
  }
  std::int64_t value = 0;
  attribute.read(H5::PredType::NATIVE_INT64, &value);
  return value;
}

}  // namespace

/// guarded(), and not for ever.
template <class Work>
auto Hdf5Reader::reading(const std::string& what, Work&& work) const {
  const TimeLimit limit(least_time + static_cast<double>(file_size_) / bytes_each_second);
  return guarded(file_, what, std::forward<Work>(work));
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : file_(file.string()) {
  H5::Exception::dontPrint();
  if (const std::string why = unreadable(file); !why.empty()) throw FileError(file_ + ": " + why);
  file_size_ = std::filesystem::file_size(file);
  if (H5Fis_hdf5(file.c_str()) == 0) throw FileError(file_ + ": is not an HDF5 file");
  reading("read as HDF5", [&] {
    h5_ = H5::H5File(file_, H5F_ACC_RDONLY, H5::FileCreatPropList::DEFAULT, without_locks());
  });
}

H5::DataSet Hdf5Reader::open(const std::string& path) const {
  if (!has(path)) throw FileError(file_ + ": has no " + path);
  return reading("read " + path, [&] {
    if (h5_.childObjType(path) != H5O_TYPE_DATASET) {
      throw FileError(file_ + ": " + path + " is not a dataset");
    }
    const H5::DataSet set = h5_.openDataSet(path);
    const H5::DSetCreatPropList made = set.getCreatePlist();
    if (made.getLayout() == H5D_VIRTUAL || H5Pget_external_count(made.getId()) != 0) {
      throw FileError(file_ + ": the numbers of " + path + " are in another file");
    }
    if (exceeds_file(extent_of(set.getSpace()), set.getDataType().getSize(), file_size_)) {
      throw FileError(file_ + ": " + path +
                      " says that it holds more than a file of this size can");
    }
    return set;
  });
}

bool Hdf5Reader::has(const std::string& path) const {
  return reading("look for " + path, [&] { return holds(path); });
}

bool Hdf5Reader::holds(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (!h5_.nameExists(part)) return false;
    H5L_info_t link;
    if (H5Lget_info(h5_.getId(), part.c_str(), &link, H5P_DEFAULT) < 0) {
      throw FileError(file_ + ": " + part + " cannot be looked up");
    }
    if (link.type != H5L_TYPE_HARD) {
      throw FileError(file_ + ": " + part + " is a link; only what the file itself has is read");
    }
    if (end == std::string::npos) return true;
    if (h5_.childObjType(part) != H5O_TYPE_GROUP) {
      throw FileError(file_ + ": " + part + " is not a group");
    }
  }
}

std::string Hdf5Reader::root_text(const std::string& name) const {
  return reading("read attribute " + name, [&] {
    return text_of(h5_.openGroup("/").openAttribute(name), file_ + ": attribute " + name);
  });
}

bool Hdf5Reader::has_root_attribute(const std::string& name) const {
  return reading("look for attribute " + name, [&] { return h5_.openGroup("/").attrExists(name); });
}

int Hdf5Reader::root_int(const std::string& name) const {
  return reading("read attribute " + name, [&] {
    const std::int64_t value =
        whole_number_of(h5_.openGroup("/").openAttribute(name), file_ + ": attribute " + name);
    if (!std::in_range<int>(value)) {
      throw FileError(fmt::format("{}: attribute {} is {}", file_, name, value));
    }
    return static_cast<int>(value);
  });
}

std::optional<std::int64_t> Hdf5Reader::attribute_int(const std::string& group,
                                                      const std::string& name) const {
  return reading("read attribute " + name + " of " + group, [&] {
    require_group(group);
    const H5::Group members = h5_.openGroup(group);
    if (!members.attrExists(name)) return std::optional<std::int64_t>();
    return std::optional(whole_number_of(members.openAttribute(name),
                                         file_ + ": attribute " + name + " of " + group));
  });
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read the shape of " + path, [&] { return extent_of(set.getSpace()); });
}

std::string Hdf5Reader::attribute(const std::string& path, const std::string& name) const {
  const H5::DataSet set = open(path);
  return reading("read attribute " + name + " of " + path, [&] {
    return text_of(set.openAttribute(name), file_ + ": attribute " + name + " of " + path);
  });
}

H5T_class_t Hdf5Reader::type(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read " + path, [&] { return set.getTypeClass(); });
}

std::vector<double> Hdf5Reader::doubles(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read " + path, [&] {
    const H5T_class_t type = set.getTypeClass();
    if (type != H5T_FLOAT && type != H5T_INTEGER) {
      throw FileError(file_ + ": " + path + " does not hold numbers");
    }
    std::vector<double> values(size_of(extent_of(set.getSpace())));
    set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
    return values;
  });
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read " + path, [&] {
    const H5T_class_t type = set.getTypeClass();
    if (type != H5T_ENUM && type != H5T_INTEGER) {
      throw FileError(file_ + ": " + path + " does not hold whole numbers");
    }
    if (type == H5T_ENUM && set.getDataType().getSize() != 1) {
      throw FileError(file_ + ": " + path + " is not an enumeration of one byte");
    }
    std::vector<std::int64_t> values(size_of(extent_of(set.getSpace())));
    if (type == H5T_ENUM) {
      std::vector<std::uint8_t> raw(values.size());
      set.read(raw.data(), set.getDataType());
      std::copy(raw.begin(), raw.end(), values.begin());
    } else {
      set.read(values.data(), H5::PredType::NATIVE_INT64);
    }
    return values;
  });
}

std::vector<std::string> Hdf5Reader::texts(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read " + path, [&] {
    if (set.getTypeClass() != H5T_STRING) {
      throw FileError(file_ + ": " + path + " does not hold texts");
    }
    const H5::StrType type = set.getStrType();
    const std::size_t count = size_of(extent_of(set.getSpace())), size = type.getSize();
    std::vector<std::string> values;
    if (!type.isVariableStr()) {
      std::vector<char> raw(count * size);
      set.read(raw.data(), type);
      for (std::size_t i = 0; i < count; ++i) {
        values.push_back(unpadded(raw.data() + i * size, size, type.getStrpad()));
      }
      return values;
    }
    std::vector<char*> raw(count);
    set.read(raw.data(), type);
    for (const char* text : raw) values.emplace_back(text != nullptr ? text : "");
    H5::DataSet::vlenReclaim(raw.data(), type, set.getSpace());
    return values;
  });
}

std::string Hdf5Reader::text(const std::string& path) const {
  if (size_of(shape(path)) != 1) throw FileError(file_ + ": " + path + " is not one text");
  return texts(path).at(0);
}

std::map<std::string, std::string> Hdf5Reader::words(const std::string& path) const {
  const H5::DataSet set = open(path);
  return reading("read attributes of " + path, [&] {
    std::map<std::string, std::string> words{{"type", type_text(set)}};
    for (int k = 0; k < set.getNumAttrs(); ++k) {
      const H5::Attribute attribute = set.openAttribute(static_cast<unsigned>(k));
      const std::string name = attribute.getName();
      std::string& text = words[name];
      double number = 0;
      if (name == "DIMENSION_LIST" || name == "REFERENCE_LIST") continue;  // labels below
      if (attribute.getTypeClass() == H5T_STRING) {
        text = text_of(attribute, file_ + ": " + path + ": attribute " + name);
      } else if (attribute.getTypeClass() == H5T_FLOAT &&
                 attribute.getSpace().getSimpleExtentNpoints() == 1) {
        attribute.read(H5::PredType::NATIVE_DOUBLE, &number);
        text = fmt::format("{}", number);
      }
    }
    for (int axis = 0; axis < set.getSpace().getSimpleExtentNdims(); ++axis) {
      if (H5DSis_scale(set.getId()) > 0) break;
      H5DSiterate_scales(set.getId(), static_cast<unsigned>(axis), nullptr, note_label,
                         &words[fmt::format("labels of axis {}", axis)]);
    }
    return words;
  });
}

void Hdf5Reader::add_datasets(const std::string& group, std::vector<std::string>& paths) const {
  for (const std::string& name : names(group.empty() ? "/" : group)) {
    const std::string path = group + "/" + name;
    H5L_info_t link;
    const bool own = H5Lget_info(h5_.getId(), path.c_str(), &link, H5P_DEFAULT) >= 0;
    if (!own || link.type != H5L_TYPE_HARD) continue;  // labels have their name in other groups too
    const H5O_type_t type = reading("read " + path, [&] { return h5_.childObjType(path); });
    if (type == H5O_TYPE_GROUP && std::ranges::count(path, '/') < deepest_group) {
      add_datasets(path, paths);
    }
    if (type == H5O_TYPE_DATASET) paths.push_back(path);
  }
}

std::vector<std::string> Hdf5Reader::datasets() const {
  std::vector<std::string> paths;
  add_datasets("", paths);
  return paths;
}

void Hdf5Reader::require_group(const std::string& path) const {
  if (path == "/") return;
  if (!has(path)) throw FileError(file_ + ": has no " + path);
  if (reading("read " + path, [&] { return h5_.childObjType(path); }) != H5O_TYPE_GROUP) {
    throw FileError(file_ + ": " + path + " is not a group");
  }
}

std::vector<std::string> Hdf5Reader::names(const std::string& group) const {
  require_group(group);
  return reading("list " + group, [&] {
    const H5::Group members = h5_.openGroup(group);
    const hsize_t count = members.getNumObjs();
    if (count > most_names) {
      throw FileError(
          fmt::format("{}: {} holds {} objects (at most {})", file_, group, count, most_names));
    }
    std::vector<std::string> names;
    for (hsize_t i = 0; i < count; ++i) names.push_back(members.getObjnameByIdx(i));
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
