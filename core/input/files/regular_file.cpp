#include "core/input/files/regular_file.hpp"

namespace hagfish {

std::string unreadable(const std::filesystem::path& file) {
  using Type = std::filesystem::file_type;
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  switch (status.type()) {
    case Type::regular:
      return "";
    case Type::not_found:
      return "no such file";
    case Type::directory:
      return "is a directory";
    default:
      return error ? "cannot be read: " + error.message() : "is not a regular file";
  }
}

}  // namespace hagfish
