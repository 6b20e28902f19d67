#include "experiments/sweep/appended_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {

AppendedFile::AppendedFile(std::filesystem::path file)
    : file_(std::move(file)),
      descriptor_(::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw FileError(file_.string() + ": cannot be opened: " + std::strerror(errno));
  }
}

AppendedFile::~AppendedFile() { ::close(descriptor_); }

void AppendedFile::add(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw WriteError(file_.string() + ": cannot be written: " + std::strerror(errno));
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace hagfish
