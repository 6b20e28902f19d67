#include "core/log/hdf5_trial.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

// CPU time, s; a log of 20 MB takes 0.02 s.
constexpr double least_time = 0.5;
constexpr double bytes_each_second = 2e7;                   // one more second for each
constexpr std::size_t largest_read = std::size_t{1} << 30;  // of one dataset, bytes

/// What is there of `count` values of `type`, by `read`, thrown away. The caller goes without what
/// is too large to be tried.
template <class Read>
void read_values(hid_t type, hid_t space, Read read) {
  const hid_t native = H5Tget_native_type(type, H5T_DIR_ASCEND);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const std::size_t size = native < 0 ? 0 : H5Tget_size(native);
  if (count > 0 && size > 0 && static_cast<std::size_t>(count) <= largest_read / size) {
    std::vector<char> values(static_cast<std::size_t>(count) * size);
    if (read(native, values.data()) >= 0 && H5Tdetect_class(native, H5T_VLEN) > 0) {
      H5Dvlen_reclaim(native, space, H5P_DEFAULT, values.data());
    }
  }
  if (native >= 0) H5Tclose(native);
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/, void* /*data*/) {
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return 0;
  const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  read_values(type, space,
              [&](hid_t native, void* values) { return H5Aread(attribute, native, values); });
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return 0;
}

/// Whether the numbers are in the file itself: no other file is opened here.
bool own_numbers(hid_t set) {
  const hid_t made = H5Dget_create_plist(set);
  const bool own =
      made >= 0 && H5Pget_layout(made) != H5D_VIRTUAL && H5Pget_external_count(made) == 0;
  if (made >= 0) H5Pclose(made);
  return own;
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* info, void* /*data*/) {
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
  if (object < 0) return 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, nullptr);
  if (info->type == H5O_TYPE_DATASET && own_numbers(object)) {
    const hid_t type = H5Dget_type(object), space = H5Dget_space(object);
    read_values(type, space, [&](hid_t native, void* values) {
      return H5Dread(object, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    });
    H5Sclose(space);
    H5Tclose(type);
  }
  H5Oclose(object);
  return 0;
}

/// What the other process does, and its end.
[[noreturn]] void read_all(const std::string& file, double time) {
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
  // What reads memory that it gave back, as some damaged heaps make HDF5 do, crashes here already.
  mallopt(M_PERTURB, 0xa5);
  // Nobody is to read what a crash has to say.
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (h5 >= 0) {
      H5Ovisit2(h5, H5_INDEX_NAME, H5_ITER_NATIVE, read_object, nullptr, H5O_INFO_BASIC);
    }
  } catch (const std::exception&) {  // out of memory, which the reader will say too
  }
  ::_exit(0);
}

}  // namespace

void try_hdf5(const std::filesystem::path& file) {
  const double time =
      least_time + static_cast<double>(std::filesystem::file_size(file)) / bytes_each_second;
  const pid_t child = ::fork();
  if (child == 0) read_all(file.string(), time);
  int status = 0;
  pid_t ended = child;
  while (child > 0 && (ended = ::waitpid(child, &status, 0)) < 0 && errno == EINTR) {
  }
  if (child < 0 || ended < 0) {
    throw FileError(file.string() + ": cannot start a process to read it: " + std::strerror(errno));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const bool endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF;
  throw FileError(file.string() + ": the file is damaged: HDF5 " +
                  (endless ? "comes to no end reading it" : "crashes reading it"));
}

}  // namespace hagfish
