// A file that grows.
#pragma once

#include <filesystem>
#include <string_view>

namespace hagfish {

/// Open for as long as this lives: what is added waits for no disk, and survives the process.
class AppendedFile {
 public:
  /// Made where it is not there. Throws FileError where it cannot be opened.
  explicit AppendedFile(std::filesystem::path file);
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  /// Adds all of `text` behind what the file holds: of lines added one by one, a kill leaves whole
  /// ones but for the last. Throws WriteError where that fails.
  void add(std::string_view text);

 private:
  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace hagfish
