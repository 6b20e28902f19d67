#include "experiments/common/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace hagfish {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();  // fails where there is nothing to read
  if (!stream || text.bad()) throw FileError(file.string() + ": cannot be read");
  return text.str();
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
