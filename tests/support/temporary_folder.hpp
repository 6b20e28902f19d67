// A folder for the files of one test.
#pragma once

#include <filesystem>
#include <string>

namespace hagfish {

/// An empty folder that no other test and no other process has; gone, with all in it, at the end.
class TemporaryFolder {
 public:
  /// Throws std::system_error where there can be none.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes `text` to the file `name`, in folders that this makes where need be; returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace hagfish
