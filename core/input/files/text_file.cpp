#include "core/input/files/text_file.hpp"

#include <fstream>

#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// Bytes of a text file at most. A scene with the whole state of 400 bodies has some 30,000.
constexpr std::size_t largest_text = std::size_t{1} << 20;

}  // namespace

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

std::string read_text_file(const std::filesystem::path& file) {
  if (const std::string why = unreadable(file); !why.empty()) {
    throw_input_error(file.string() + ": " + why);
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(largest_text + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || !stream.is_open()) throw_input_error(file.string() + ": cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > largest_text) {
    throw_input_error(file.string() + ": is larger than " + std::to_string(largest_text) +
                      " bytes");
  }
  return text;
}

}  // namespace hagfish
