#include "experiments/mujoco/encoder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> arguments(const fs::path& file, FilmFormat format, int width, int height,
                                   double rate) {
  std::vector<std::string> list{"ffmpeg",       "-nostdin",
                                "-hide_banner", "-loglevel",
                                "error",        "-y",
                                "-f",           "rawvideo",
                                "-pix_fmt",     "rgb24",
                                "-s",           fmt::format("{}x{}", width, height),
                                "-r",           fmt::format("{}", rate),
                                "-i",           "pipe:0"};
  const std::vector<std::string> of_format =
      format == FilmFormat::mp4
          // Pixels as every player takes them; a quality at which rings stay sharp.
          ? std::vector<std::string>{"-c:v",      "libx264",    "-preset",  "veryfast",
                                     "-crf",      "20",         "-pix_fmt", "yuv420p",
                                     "-movflags", "+faststart", "-f",       "mp4"}
          : std::vector<std::string>{
                "-vf", "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse", "-f",
                "gif"};
  list.insert(list.end(), of_format.begin(), of_format.end());
  list.push_back(fs::absolute(file).string());
  return list;
}

std::vector<std::string> reading(const fs::path& file) {
  return {"ffmpeg",
          "-nostdin",
          "-hide_banner",
          "-loglevel",
          "error",
          "-xerror",
          "-i",
          fs::absolute(file).string(),
          "-f",
          "null",
          "-"};
}

/// Starts a program with its standard input from `input`, where that is not negative, and with its
/// standard error to the file `said`. Returns the system's error number, or 0.
int spawn(std::vector<std::string> list, int input, const fs::path& said, pid_t& process) {
  std::vector<char*> argv;
  for (std::string& argument : list) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (input >= 0) posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, said.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int error = posix_spawnp(&process, "ffmpeg", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// Whether it ended well.
bool ended_well(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

FilmFormat film_format(const std::string& file) {
  const std::string extension = fs::path(file).extension().string();
  if (extension == ".mp4") return FilmFormat::mp4;
  if (extension == ".gif") return FilmFormat::gif;
  throw_input_error(file + ": --out must end in .mp4 or .gif");
}

void require_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((fs::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return;
  }
  throw InputError("no ffmpeg: a film needs it (Debian: apt-get install ffmpeg)");
}

FilmEncoder::FilmEncoder(const fs::path& file, FilmFormat format, int width, int height,
                         double rate)
    : file_(file), said_(file.string() + ".ffmpeg") {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("ffmpeg: no pipe: ") + std::strerror(errno));
  }
  const int error = spawn(arguments(file, format, width, height, rate), ends[0], said_, process_);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    ::close(pipe_);
    throw std::runtime_error(std::string("ffmpeg: cannot be started: ") + std::strerror(error));
  }
  std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that gives up is told by add()
}

FilmEncoder::~FilmEncoder() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  fs::remove(said_, ignored);
}

void FilmEncoder::fail() {
  std::ifstream file(said_);
  std::string line;
  std::getline(file, line);
  throw std::runtime_error(file_.string() +
                           ": ffmpeg: " + (line.empty() ? "gave up" : printable(line)));
}

void FilmEncoder::add(const Image& image) {
  for (std::size_t done = 0; done < image.rgb.size();) {
    const ssize_t count = ::write(pipe_, image.rgb.data() + done, image.rgb.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail();
    done += static_cast<std::size_t>(count);
  }
}

void FilmEncoder::finish() {
  ::close(pipe_);
  pipe_ = -1;
  const bool written = ended_well(std::exchange(process_, -1));
  if (!written) fail();
  // On a full disk ffmpeg may end well and leave a film without its index.
  if (const int error = spawn(reading(file_), -1, said_, process_); error != 0) {
    process_ = -1;
    throw std::runtime_error(file_.string() +
                             ": ffmpeg: cannot be started: " + std::strerror(error));
  }
  const bool whole = ended_well(std::exchange(process_, -1));
  std::error_code ignored;
  if (!whole || fs::file_size(said_, ignored) != 0) fail();
}

}  // namespace hagfish
