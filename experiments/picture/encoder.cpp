#include "experiments/picture/encoder.hpp"

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
    : said_(file.string() + ".ffmpeg") {
  std::vector<std::string> list = arguments(file, format, width, height, rate);
  std::vector<char*> argv;
  for (std::string& argument : list) argv.push_back(argument.data());
  argv.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("ffmpeg: no pipe: ") + std::strerror(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, said_.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int error = posix_spawnp(&process_, "ffmpeg", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
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
  throw std::runtime_error("ffmpeg: " + (line.empty() ? "gave up" : printable(line)));
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
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
}

}  // namespace hagfish
