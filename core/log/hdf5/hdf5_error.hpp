// How failures of HDF5 reach the user.
#pragma once

#include <H5Cpp.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace hagfish {

/// A file that cannot be read or written: what() is one line that names the file and the reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that could not be written, for no fault of the command line.
class WriteError : public FileError {
 public:
  using FileError::FileError;
};

/// Opens files where the system has no locks, too, and lets others read what is open.
inline H5::FileAccPropList without_locks() {
  H5::FileAccPropList access;
  H5Pset_file_locking(access.getId(), false, true);
  return access;
}

/// Runs `work`, turning HDF5's exceptions into one line. The system's reason (disk full, no
/// permission) is more useful than HDF5's own, where there is one.
template <class Work>
auto guarded(const std::string& file, const std::string& what, Work&& work) {
  errno = 0;
  try {
    return work();
  } catch (const H5::Exception& e) {
    const int reason = errno;
    throw FileError(file + ": cannot " + what + ": " +
                    (reason != 0 ? std::strerror(reason) : e.getDetailMsg()));
  }
}

}  // namespace hagfish
