#include "experiments/program/scripts.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/log/hdf5/output_file.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

constexpr const char* python = "/usr/bin/python3";  // Debian's own, which has its packages

/// Runs a program and waits for it; -1 where it cannot be started or ends by a signal.
int run(std::vector<std::string> list, bool silent) {
  std::vector<char*> argv;
  for (std::string& argument : list) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (silent) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
  } else {
    posix_spawn_file_actions_adddup2(&actions, ::fileno(stderr), STDERR_FILENO);
  }
  pid_t process = -1;
  const int error = posix_spawn(&process, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

fs::path script_file(const std::string& script) {
  const fs::path installed = own_program().parent_path().parent_path() / HAGFISH_SHARE / "drawing";
  for (const fs::path& folder : {installed, fs::path(HAGFISH_DRAWING)}) {
    std::error_code error;
    if (fs::is_regular_file(folder / script, error)) return folder / script;
  }
  throw InputError(fmt::format("{}: the Python scripts for figures are neither in {} nor in {}",
                               script, installed.string(), HAGFISH_DRAWING));
}

}  // namespace

fs::path own_program() { return fs::read_symlink("/proc/self/exe"); }

int run_script(const std::string& script, const std::vector<std::string>& arguments) {
  // What a figure shows and how is not the caller's locale's or number of threads'.
  for (const char* name : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"}) ::setenv(name, "1", 1);
  ::setenv("LC_ALL", "C.UTF-8", 1);
  const fs::path file = script_file(script);
  if (::access(python, X_OK) != 0) {
    throw InputError(std::string("no ") + python + ": figures need it");
  }
  if (run({python, "-c", "import h5py, matplotlib"}, true) != 0) {
    throw InputError(std::string(python) +
                     " has no h5py or matplotlib: figures need them (Debian: apt-get install "
                     "python3-h5py python3-matplotlib)");
  }
  std::vector<std::string> list{python, "-B", file.string(), "--"};
  list.insert(list.end(), arguments.begin(), arguments.end());
  const int code = run(list, false);
  if (code < 0) throw std::runtime_error(script + ": Python was killed by a signal");
  return code;
}

void draw_from_text(const std::string& script, const std::string& text, const std::string& out,
                    bool force) {
  if (fs::path(out).extension() != ".png") throw InputError(out + ": must end in .png");
  OutputFile picture(out, replaced_if(force));
  const std::string table = picture.partial().string() + ".csv";
  const std::string drawn = picture.partial().string() + ".png";
  std::error_code ignored;
  std::ofstream stream(table);
  stream << text;
  stream.close();
  const int code = stream ? run_script(script, {table, drawn}) : -1;
  fs::remove(table, ignored);
  if (!stream) throw FileError(table + ": cannot be written");
  if (code != 0) throw std::runtime_error(out + ": " + script + " could not draw it");
  fs::rename(drawn, picture.partial(), ignored);
  if (ignored) throw FileError(out + ": cannot be written: " + ignored.message());
  picture.publish();
}

}  // namespace hagfish
