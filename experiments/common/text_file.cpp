#include "experiments/common/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/input/files/text_file.hpp"

namespace hagfish {

std::string text_of(const std::filesystem::path& file) {
  if (const std::string why = unreadable(file); !why.empty()) {
    throw FileError(file.string() + ": " + why);
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw FileError(file.string() + ": cannot be read");
  return text;
}

void TextFile::write(const std::string& text) {
  const std::string partial = file_.partial().string();
  errno = 0;
  std::ofstream stream(partial, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    const std::string reason = std::strerror(errno);
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw WriteError(partial + ": cannot be written: " + reason);
  }
  file_.publish();
}

}  // namespace hagfish
