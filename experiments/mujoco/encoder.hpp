// Pictures to a film, by Debian's ffmpeg.
#pragma once

#include <filesystem>
#include <string>

#include "mujoco_ref/offscreen.hpp"

namespace hagfish {

enum class FilmFormat { mp4, gif };

/// Format by the file's name. Throws InputError for any other.
FilmFormat film_format(const std::string& file);

/// Throws InputError, one line, where there is no ffmpeg.
void require_ffmpeg();

/// An ffmpeg at work, which reads pictures of one size.
class FilmEncoder {
 public:
  /// Begins a film of so many pictures a second in `file`, replacing it. Throws std::runtime_error
  /// where ffmpeg cannot be started.
  FilmEncoder(const std::filesystem::path& file, FilmFormat format, int width, int height,
              double rate);
  /// Ends ffmpeg, finished or not.
  ~FilmEncoder();
  FilmEncoder(const FilmEncoder&) = delete;
  FilmEncoder& operator=(const FilmEncoder&) = delete;

  /// Appends a picture. Throws std::runtime_error where ffmpeg has given up.
  void add(const Image& image);
  /// Completes the film and reads it again. Throws std::runtime_error, with what ffmpeg said, where
  /// either fails.
  void finish();

 private:
  [[noreturn]] void fail();
  std::filesystem::path file_;
  std::filesystem::path said_;  ///< what ffmpeg writes to standard error
  int process_ = -1;
  int pipe_ = -1;
};

}  // namespace hagfish
