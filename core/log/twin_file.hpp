// A file that grows in steps and is whole at every moment, whatever ends the process.
#pragma once

#include <cstddef>
#include <filesystem>

namespace hagfish {

/// Two copies of FILE take turns: the older one, FILE.next, is changed and then gets the name FILE,
/// in one operation of the file system. A full disk is found before the copy is touched. What
/// another process has open is not changed: a new copy takes its place.
class TwinFile {
 public:
  /// FILE exists; FILE.next, of a process that is gone, is removed.
  explicit TwinFile(std::filesystem::path file);
  /// FILE stays; FILE.next goes.
  ~TwinFile();
  TwinFile(const TwinFile&) = delete;
  TwinFile& operator=(const TwinFile&) = delete;

  /// Makes FILE.next a copy of FILE where there is none, or one that is being read. Whether it
  /// made one.
  bool prepare();
  /// FILE.next, which can take on `room` bytes more. Throws FileError where the disk has no room.
  const std::filesystem::path& begin(std::size_t room);
  /// FILE.
  const std::filesystem::path& whole() const { return file_; }
  /// FILE.next, as changed, becomes FILE. Throws FileError where it cannot.
  void commit();
  /// Leaves both to another process.
  void forget();
  /// FILE.next is not to be used, and goes.
  void abandon();

 private:
  std::filesystem::path file_, next_, last_;
};

}  // namespace hagfish
