#include "experiments/program/text_file.hpp"

#include <fmt/os.h>

#include <system_error>

#include "core/log/hdf5_error.hpp"

namespace hagfish {

void TextFile::write(const std::string& text) {
  const std::string partial = file_.partial().string();
  try {
    auto out = fmt::output_file(partial);
    out.print("{}", text);
    out.close();
  } catch (const std::system_error& error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw FileError(partial + ": cannot be written: " + error.code().message());
  }
  file_.publish();
}

}  // namespace hagfish
