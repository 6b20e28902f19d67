// A file that is made over time: reserved by name, grown beside it, named when it is whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {

/// What is to become of a FILE, or a FILE.part of a process that is gone, that exists.
enum class Existing {
  refuse,   ///< it stays
  replace,  ///< it is replaced
  go_on     ///< FILE.part is gone on with, or FILE: it stays until there is more (put())
};

constexpr Existing replaced_if(bool force) { return force ? Existing::replace : Existing::refuse; }

/// Reserves FILE while it lives. What is made goes to FILE.part, so that FILE is never half-written
/// and what was made survives whatever ends the process; FILE.lock, locked by the kernel, tells a
/// process at work from one that is gone. Symbolic links are followed and stay. A forked child has
/// nothing of it: what it destroys stays the parent's.
class OutputFile {
 public:
  /// Throws FileError where FILE is no name or that of no regular file; where it, or FILE.part,
  /// exists and is to be refused, or both or none do and one is to be gone on with; where another
  /// process is making FILE; or where its folder cannot be written.
  OutputFile(const std::filesystem::path& file, Existing existing);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& partial() const { return partial_; }
  /// What is gone on with, until put(): FILE or FILE.part.
  const std::filesystem::path& earlier() const { return whole_ ? file_ : partial_; }
  /// Whether this is no copy in a forked child.
  bool is_ours() const;

  /// Makes the file `made` FILE.part, in place of what is gone on with. Throws FileError.
  void put(const std::filesystem::path& made);

  /// Gives FILE.part its name. Throws FileError, and keeps FILE.part, where that fails or a FILE
  /// that is not to be replaced has appeared meanwhile.
  void publish();

 private:
  void take_lock();
  /// What stands in the way, or an empty text.
  std::string obstacle() const;

  std::filesystem::path file_, partial_, lock_;
  Existing existing_;
  bool whole_ = false;  // FILE is gone on with
  int lock_descriptor_ = -1;
  int process_;
};

// Room on the disk and in memory, sure before it is needed: HDF5 can neither close nor abandon a
// file on a full disk.

/// Allocates `bytes` behind the end of a file, which HDF5 cuts off where it does not use them.
/// Returns the system's error number where there is no room, else 0.
[[nodiscard]] int reserve_room(const std::filesystem::path& file, std::size_t bytes);

/// Throws std::bad_alloc where the process cannot have `bytes` more of memory, beside which HDF5
/// crashes: it writes to what it was not given.
void require_memory(std::size_t bytes);

}  // namespace hagfish
