#include "core/log/hdf5_copy.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "core/log/hdf5_datasets.hpp"
#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

// CPU time, s; a log of 10 MB takes 0.02 s, a set of 10,000 QPs 1 s.
constexpr double least_time = 2;
constexpr double bytes_each_second = 2e7;  // one more second for each
/// Groups within groups that are looked into; the project's own have two.
constexpr int deepest_group = 8;
/// Memory of a copy grows by steps of so many bytes.
constexpr std::size_t memory_increment = std::size_t{1} << 20;
/// How the other process ends.
enum Ending { copied, not_hdf5, no_room };

/// An attribute as the same one of `to`. What cannot be read is left out, and so are references.
herr_t copy_attribute(hid_t from, const char* name, const H5A_info_t* /*info*/, void* to) {
  if (name == std::string("DIMENSION_LIST") || name == std::string("REFERENCE_LIST")) return 0;
  const hid_t attribute = H5Aopen(from, name, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const hsize_t bytes = H5Aget_storage_size(attribute);
  if (type >= 0 && count >= 0) {
    std::vector<char> values(std::max<std::size_t>(bytes, count * H5Tget_size(type)));
    const bool read = count == 0 || H5Aread(attribute, type, values.data()) >= 0;
    const hid_t made =
        read ? H5Acreate2(*static_cast<hid_t*>(to), name, type, space, H5P_DEFAULT, H5P_DEFAULT)
             : H5I_INVALID_HID;
    if (made >= 0 && count > 0) H5Awrite(made, type, values.data());
    if (made >= 0) H5Aclose(made);
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return 0;
}

/// Where the datasets of the original are in the copy, by address.
using Places = std::map<haddr_t, std::string>;

struct Group {
  hid_t copy;
  int depth;
  std::string path;
  Places* places;
};

herr_t copy_member(hid_t from, const char* name, const H5L_info_t* link, void* data);

/// Attributes and members of the group `from`, each by itself.
void copy_members(hid_t from, Group to) {
  H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, copy_attribute, &to.copy);
  H5Literate(from, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, copy_member, &to);
}

/// Copies the dataset `object`, which `from` has as `name`, into `to`, or links it to its copy.
void copy_dataset(hid_t from, hid_t object, const char* name, const Group& to) {
  H5O_info_t info;
  if (H5Oget_info(object, &info) < 0) return;
  if (const auto copied = to.places->find(info.addr); copied != to.places->end()) {
    H5Lcreate_hard(to.copy, copied->second.c_str(), to.copy, name, H5P_DEFAULT, H5P_DEFAULT);
    return;
  }
  hid_t copy = H5I_INVALID_HID;
  if (is_plain(object)) {
    copy = copy_plain(object, to.copy, name);
    if (copy < 0) H5Lcreate_soft(damaged_link, to.copy, name, H5P_DEFAULT, H5P_DEFAULT);
  } else {
    const hid_t bare = H5Pcreate(H5P_OBJECT_COPY);
    H5Pset_copy_object(bare, H5O_COPY_WITHOUT_ATTR_FLAG);
    if (H5Ocopy(from, name, to.copy, name, bare, H5P_DEFAULT) >= 0) {
      copy = H5Dopen2(to.copy, name, H5P_DEFAULT);
    }
    H5Pclose(bare);
  }
  if (copy < 0) return;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, copy_attribute, &copy);
  H5Dclose(copy);
  to.places->emplace(info.addr, to.path + name);
}

herr_t copy_member(hid_t from, const char* name, const H5L_info_t* link, void* data) {
  const Group& to = *static_cast<Group*>(data);
  if (link->type != H5L_TYPE_HARD) {
    // Wherever it leads: links are not followed.
    H5Lcreate_soft("elsewhere", to.copy, name, H5P_DEFAULT, H5P_DEFAULT);
    return 0;
  }
  const hid_t object = H5Oopen(from, name, H5P_DEFAULT);
  const H5I_type_t type = H5Iget_type(object);
  if (type == H5I_DATASET) {
    copy_dataset(from, object, name, to);
  } else if (type != H5I_GROUP) {
    H5Ocopy(from, name, to.copy, name, H5P_DEFAULT, H5P_DEFAULT);
  } else if (to.depth < deepest_group) {
    const hid_t group = H5Gcreate2(to.copy, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    copy_members(object, {group, to.depth + 1, to.path + name + "/", to.places});
    H5Gclose(group);
  }
  if (object >= 0) H5Oclose(object);
  return 0;
}

/// A dataset of the copy, whose axes are labelled as the original's are.
struct Labelled {
  hid_t copy;
  const Places* places;
};

herr_t attach_labels(hid_t /*set*/, unsigned axis, hid_t scale, void* data) {
  const Labelled& to = *static_cast<Labelled*>(data);
  H5O_info_t info;
  if (H5Oget_info(scale, &info) < 0) return 0;
  const auto place = to.places->find(info.addr);
  if (place == to.places->end()) return 0;
  const hid_t labels = H5Dopen2(to.copy, place->second.c_str(), H5P_DEFAULT);
  if (labels >= 0) {
    H5DSattach_scale(to.copy, labels, axis);
    H5Dclose(labels);
  }
  return 0;
}

/// Labels the axes of all datasets: what says so are references into the original.
void copy_labels(hid_t from, hid_t to, const Places& places) {
  for (const auto& [address, path] : places) {
    const hid_t set = H5Dopen2(from, path.c_str(), H5P_DEFAULT);
    Labelled labelled{H5Dopen2(to, path.c_str(), H5P_DEFAULT), &places};
    const hid_t space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_ndims(space);
    for (int axis = 0; axis < rank; ++axis) {
      H5DSiterate_scales(set, static_cast<unsigned>(axis), nullptr, attach_labels, &labelled);
    }
    H5Sclose(space);
    H5Dclose(labelled.copy);
    H5Dclose(set);
  }
}

/// The bytes of the open file `h5`; none where HDF5 does not give them.
std::vector<char> image_of(hid_t h5) {
  const ssize_t size = H5Fget_file_image(h5, nullptr, 0);
  std::vector<char> image(std::max<ssize_t>(size, 0));
  if (size > 0 && H5Fget_file_image(h5, image.data(), image.size()) != size) image.clear();
  return image;
}

/// Hands `bytes` to `move` (as write and read) until all went through; false where some did not.
template <class Bytes, class Move>
bool move_all(std::span<Bytes> bytes, int descriptor, Move move) {
  while (!bytes.empty()) {
    const ssize_t more = move(descriptor, bytes.data(), bytes.size());
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    bytes = bytes.subspan(more);
  }
  return true;
}

bool write_all(std::span<const char> bytes, int descriptor) {
  return move_all(bytes, descriptor, ::write);
}

/// What the other process does after it has begun, and its end.
[[noreturn]] void copy_all(const std::string& file, int descriptor) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    const hid_t from = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (from < 0) ::_exit(not_hdf5);
    const hid_t in_memory = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(in_memory, memory_increment, 0);
    const hid_t to = H5Fcreate("copy", H5F_ACC_TRUNC, H5P_DEFAULT, in_memory);
    const hid_t root = H5Gopen2(from, "/", H5P_DEFAULT), root_copy = H5Gopen2(to, "/", H5P_DEFAULT);
    Places places;
    copy_members(root, {root_copy, 0, "/", &places});
    copy_labels(from, to, places);
    H5Fflush(to, H5F_SCOPE_LOCAL);
    const std::vector<char> image = image_of(to);
    const std::size_t size = image.size();
    const bool told = write_all({reinterpret_cast<const char*>(&size), sizeof size}, descriptor);
    ::_exit(size > 0 && told && write_all(image, descriptor) ? copied : no_room);
  } catch (const std::exception&) {
    ::_exit(no_room);
  }
}

/// Lets this process, newly forked, end of whatever happens in it, silently and after `time`, s, of
/// CPU time.
void expect_the_worst(double time) {
  for (const int signal :
       {SIGINT, SIGTERM, SIGHUP, SIGPROF, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    std::signal(signal, SIG_DFL);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const double whole = std::floor(time);
  const itimerval end{{0, 0},
                      {static_cast<time_t>(whole), static_cast<suseconds_t>(1e6 * (time - whole))}};
  setitimer(ITIMER_PROF, &end, nullptr);  // SIGPROF
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
}

/// The end of `child` as waitpid gives it.
int await(pid_t child, const std::string& file) {
  int status = 0;
  pid_t ended = child;
  while (child > 0 && (ended = ::waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  if (child < 0 || ended < 0) {
    throw FileError(file + ": cannot start a process to read it: " + std::strerror(errno));
  }
  return status;
}

void require_copied(int status, const std::string& file) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) {
    throw FileError(file + ": the file is damaged: HDF5 does not finish reading it");
  }
  if (WIFSIGNALED(status)) {
    // HDF5 does not look whether it got memory.
    rlimit memory{};
    const bool bounded = getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY;
    throw FileError(file + (bounded ? ": no memory to read it, or" : ":") +
                    " the file is damaged: HDF5 crashes when it reads it");
  }
  if (WEXITSTATUS(status) == not_hdf5) {
    guarded(file, "read as HDF5", [&] { H5::H5File(file, H5F_ACC_RDONLY); });
  }
  if (WEXITSTATUS(status) != copied) throw FileError(file + ": no memory to read it");
}

/// What another process sends, its size first. A pipe has no size, unlike a file in memory, which
/// `ulimit -f` bounds.
class Pipe {
 public:
  explicit Pipe(const std::string& file) {
    if (::pipe2(ends_, O_CLOEXEC) != 0) {
      throw FileError(file + ": cannot be read by a process: " + std::strerror(errno));
    }
  }
  ~Pipe() { close(); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  /// Where the other process writes to; it must not hold the end that this one reads from.
  int entry() {
    close(ends_[0]);
    return ends_[1];
  }
  /// What comes until the other process ends, which it does when this pipe closes: all or nothing.
  std::vector<char> bytes() {
    close(ends_[1]);
    std::size_t size = 0;
    if (!move_all(std::span(reinterpret_cast<char*>(&size), sizeof size), ends_[0], ::read)) {
      return {};
    }
    std::vector<char> all(size);
    if (!move_all(std::span(all), ends_[0], ::read)) all.clear();
    return all;
  }
  void close() {
    for (int& end : ends_) close(end);
  }

 private:
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }

  int ends_[2] = {-1, -1};
};

/// What the process `child` sends, once it has ended.
std::vector<char> received(Pipe& pipe, pid_t child, const std::string& file) {
  std::vector<char> image;
  std::exception_ptr no_memory;
  try {
    if (child > 0) image = pipe.bytes();
  } catch (const std::bad_alloc&) {
    no_memory = std::current_exception();
  }
  pipe.close();
  const int status = await(child, file);
  if (no_memory) std::rethrow_exception(no_memory);
  require_copied(status, file);
  return image;
}

}  // namespace

H5::H5File open_hdf5_copy(const std::filesystem::path& path) {
  const std::string file = path.string();
  Pipe pipe(file);
  const double time =
      least_time + static_cast<double>(std::filesystem::file_size(path)) / bytes_each_second;
  const pid_t child = ::fork();
  if (child == 0) {
    expect_the_worst(time);
    copy_all(file, pipe.entry());
  }
  std::vector<char> image = received(pipe, child, file);
  H5::FileAccPropList in_memory;
  in_memory.setCore(memory_increment, false);
  H5Pset_file_image(in_memory.getId(), image.data(), image.size());
  // HDF5 takes two files in memory of one name for the same.
  static std::atomic<int> opened = 0;
  const std::string name = fmt::format("{} ({})", file, ++opened);
  return guarded(file, "read as HDF5", [&] {
    return H5::H5File(name, H5F_ACC_RDONLY, H5::FileCreatPropList::DEFAULT, in_memory);
  });
}

void save_hdf5(const H5::H5File& copy, const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const std::vector<char> image = image_of(copy.getId());
  const bool whole = descriptor >= 0 && !image.empty() && write_all(image, descriptor);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!whole) {
    ::unlink(file.c_str());
    throw FileError(file.string() + ": cannot be written: " + std::strerror(error));
  }
}

}  // namespace hagfish
