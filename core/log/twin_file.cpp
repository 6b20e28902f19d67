#include "core/log/twin_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/log/disk_room.hpp"
#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) {
  throw FileError(file.string() + ": cannot be saved: " + std::strerror(error));
}

/// Whether no other process has the file open. The kernel gives a lease of a file that nobody else
/// has open; where it gives none at all, as on NFS, readers of HDF5 are known by their locks.
bool is_alone(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  bool alone = ::fcntl(descriptor, F_SETLEASE, F_WRLCK) == 0;
  const bool in_use = !alone && (errno == EAGAIN || errno == EBUSY);
  if (!alone && !in_use) alone = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  ::close(descriptor);  // what it holds goes with it
  return alone;
}

}  // namespace

TwinFile::TwinFile(fs::path file)
    : file_(std::move(file)), next_(file_.string() + ".next"), last_(file_.string() + ".last") {
  abandon();
}

TwinFile::~TwinFile() { abandon(); }

void TwinFile::forget() {
  next_.clear();
  last_.clear();
}

void TwinFile::abandon() {
  ::unlink(next_.c_str());
  ::unlink(last_.c_str());
}

bool TwinFile::prepare() {
  std::error_code error;
  if (fs::exists(next_, error)) {
    if (is_alone(next_)) return false;
    abandon();  // whoever reads it goes on with what it was
  }
  if (!fs::copy_file(file_, next_, error)) {
    abandon();
    fail(file_, error.value());
  }
  return true;
}

const fs::path& TwinFile::begin(std::size_t room) {
  if (const int error = reserve_room(next_, room); error != 0) {
    abandon();
    fail(file_, error);
  }
  return next_;
}

void TwinFile::commit() {
  // By links, as not every file system can exchange two names: FILE is there throughout.
  ::unlink(last_.c_str());
  if (::link(file_.c_str(), last_.c_str()) != 0 || std::rename(next_.c_str(), file_.c_str()) != 0 ||
      std::rename(last_.c_str(), next_.c_str()) != 0) {
    const int error = errno;
    abandon();
    fail(file_, error);
  }
}

}  // namespace hagfish
