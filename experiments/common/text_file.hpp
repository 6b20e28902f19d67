// A text that a command writes when its work is done.
#pragma once

#include <filesystem>
#include <string>

#include "core/log/hdf5/output_file.hpp"

namespace hagfish {

inline constexpr const char* force_help = "replace an existing file";

/// All of a file. Throws FileError where it cannot be read.
std::string text_of(const std::filesystem::path& file);

/// Reserves `file` before the work, as OutputFile does and throwing as it does.
class TextFile {
 public:
  TextFile(const std::string& file, bool force) : file_(file, replaced_if(force)) {}
  /// Throws WriteError, and leaves nothing, where it cannot be written.
  void write(const std::string& text);

 private:
  OutputFile file_;
};

}  // namespace hagfish
