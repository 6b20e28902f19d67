#include "core/log/hdf5/output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

namespace hagfish {
namespace {

namespace fs = std::filesystem;

/// Where a name leads, by way of symbolic links, the last of which may lead nowhere yet.
fs::path target_of(fs::path file) {
  constexpr int most_links = 40;  // as the kernel's own bound
  std::error_code error;
  for (int k = 0; k < most_links && fs::is_symlink(file, error); ++k) {
    file = file.parent_path() / fs::read_symlink(file, error);
  }
  return file;
}

}  // namespace

OutputFile::OutputFile(const fs::path& file, Existing existing)
    : file_(target_of(file)),
      partial_(file_.string() + ".part"),
      lock_(file_.string() + ".lock"),
      existing_(existing),
      process_(::getpid()) {
  if (!file_.has_filename()) throw FileError("'" + file_.string() + "': names no file to write");
  std::error_code error;
  if (fs::exists(file_, error) && !fs::is_regular_file(file_, error)) {
    throw FileError(file_.string() + ": is not a regular file");
  }
  if (existing == Existing::refuse && fs::exists(file_, error)) {
    throw FileError(file_.string() + ": already exists (--force replaces it)");
  }
  take_lock();
  if (const std::string reason = obstacle(); !reason.empty()) {
    fs::remove(lock_, error);
    ::close(lock_descriptor_);
    throw FileError(reason);
  }
  whole_ = existing == Existing::go_on && fs::exists(file_, error);
}

std::string OutputFile::obstacle() const {
  std::error_code error;
  const bool whole = fs::exists(file_, error);
  const bool part = fs::exists(partial_, error);
  if (existing_ == Existing::refuse && part) {
    return partial_.string() +
           ": left by a run that was interrupted; `hagfish run --resume` continues it, --force "
           "replaces it";
  }
  if (existing_ == Existing::go_on && whole && part) {
    return partial_.string() + ": cannot be continued, since " + file_.string() + " exists";
  }
  if (existing_ == Existing::go_on && !whole && !part) return file_.string() + ": no such file";
  return "";
}

/// A process that ends removes its lock file, so that the one just locked may be of no name any
/// more: then another one is taken.
void OutputFile::take_lock() {
  for (;;) {
    lock_descriptor_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_descriptor_ < 0) {
      throw FileError(file_.string() + ": cannot be created: " + std::strerror(errno));
    }
    const bool locked_it = ::flock(lock_descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (!locked_it && (errno == ENOLCK || errno == ENOSYS || errno == EOPNOTSUPP)) {
      return;  // a file system without locks
    }
    if (!locked_it) {
      const int reason = errno;
      ::close(lock_descriptor_);
      throw FileError(file_.string() +
                      (reason == EWOULDBLOCK
                           ? ": is being made by another process"
                           : std::string(": cannot be locked: ") + std::strerror(reason)));
    }
    struct stat locked {
    }, named{};
    if (::fstat(lock_descriptor_, &locked) == 0 && ::stat(lock_.c_str(), &named) == 0 &&
        locked.st_ino == named.st_ino && locked.st_dev == named.st_dev) {
      return;
    }
    ::close(lock_descriptor_);
  }
}

bool OutputFile::is_ours() const { return ::getpid() == process_; }

OutputFile::~OutputFile() {
  if (is_ours()) ::unlink(lock_.c_str());
  ::close(lock_descriptor_);
}

void OutputFile::put(const fs::path& made) {
  // FILE goes first: whatever ends the process, there are never both.
  if ((whole_ && std::rename(file_.c_str(), partial_.c_str()) != 0) ||
      std::rename(made.c_str(), partial_.c_str()) != 0) {
    throw FileError(partial_.string() + ": cannot be saved: " + std::strerror(errno));
  }
  whole_ = false;
}

void OutputFile::publish() {
  const bool replace = existing_ == Existing::replace;
  if (!replace && ::link(partial_.c_str(), file_.c_str()) == 0) {  // fails where the name is taken
    ::unlink(partial_.c_str());
    return;
  }
  // On a file system without hard links, as a USB stick's, a look at the name has to do.
  std::error_code error;
  const bool taken = !replace && fs::exists(file_, error);
  if (!taken && std::rename(partial_.c_str(), file_.c_str()) == 0) return;
  const std::string reason = taken ? "another program created this file during the run"
                                   : std::string("cannot be named: ") + std::strerror(errno);
  throw FileError(file_.string() + ": " + reason + "; the output of this run is in " +
                  partial_.string());
}

int reserve_room(const std::filesystem::path& file, std::size_t bytes) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  int error = descriptor < 0 ? errno : 0;
  if (error == 0 && bytes > 0) {
    const off_t end = ::lseek(descriptor, 0, SEEK_END);
    error = ::posix_fallocate(descriptor, end, static_cast<off_t>(bytes));
    if (error != 0 && ::ftruncate(descriptor, end) != 0) error = errno;
  }
  if (descriptor >= 0) ::close(descriptor);
  return error;
}

void require_memory(std::size_t bytes) {
  void* const room = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  ::munmap(room, bytes);
}

}  // namespace hagfish
