#include "core/log/hdf5/disk_room.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <new>

namespace hagfish {

int reserve_room(const std::filesystem::path& file, std::size_t bytes) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  int error = descriptor < 0 ? errno : 0;
  if (error == 0 && bytes > 0) {
    const off_t end = ::lseek(descriptor, 0, SEEK_END);
    error = ::posix_fallocate(descriptor, end, static_cast<off_t>(bytes));
    if (error != 0 && ::ftruncate(descriptor, end) != 0) {
      error = errno;
    }
  }
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  return error;
}

void require_memory(std::size_t bytes) {
  void* const room = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  ::munmap(room, bytes);
}

}  // namespace hagfish
