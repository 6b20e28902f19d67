// A file that is made over time: reserved by name, grown beside it, named when it is whole.
#pragma once

#include <filesystem>

#include "core/log/hdf5_error.hpp"

namespace hagfish {

/// Reserves FILE while it lives. What is made goes to FILE.part, so that FILE is never half-written
/// and what was made survives whatever ends the process; FILE.lock, locked by the kernel, tells a
/// process at work from one that is gone. Symbolic links are followed and stay.
class OutputFile {
 public:
  /// Throws FileError where FILE is no regular file; where FILE, or FILE.part of a process that
  /// is gone, exists and `replace` is not set; where another process is making FILE; or where its
  /// folder cannot be written.
  OutputFile(const std::filesystem::path& file, bool replace);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& partial() const { return partial_; }

  /// Gives FILE.part its name. Throws FileError, and keeps FILE.part, where that fails or a FILE
  /// that is not to be replaced has appeared meanwhile.
  void publish();

 private:
  void take_lock();

  std::filesystem::path file_, partial_, lock_;
  bool replace_;
  int lock_descriptor_ = -1;
};

}  // namespace hagfish
