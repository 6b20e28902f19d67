// Runs commands of the program, each in a process of its own that is forked from this one: a fresh
// start would cost more than most commands do, above all with sanitizers.
//
// Each line of standard input is a job: seconds of CPU time it may take, then the arguments,
// between tabs. Its output goes to `out.txt` and `error.txt` in the working folder. The answer is a
// line: the exit code, or minus the signal that ended it, or "late". With arguments it is the
// program itself: the scripts that a command starts call that by its name.
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/program/run_program.hpp"

namespace {

/// A job that waits takes no CPU time: it is late after this many times what it may take.
constexpr double patience = 12;

[[noreturn]] void run_job(std::vector<std::string> arguments, double seconds) {
  const rlimit time{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds) + 1};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setpgid(0, 0);  // whom it starts ends with it
  const int out = ::open("out.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int error = ::open("error.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int in = ::open("/dev/null", O_RDONLY);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(error, STDERR_FILENO);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int code = hagfish::run_program(static_cast<int>(arguments.size()), argv.data());
  std::fflush(nullptr);
  ::_exit(code);
}

/// What became of `child`, which may take `seconds`.
std::string await(pid_t child, double seconds) {
  const int handle = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  pollfd ended{handle, POLLIN, 0};
  const bool late = ::poll(&ended, 1, static_cast<int>(1e3 * patience * seconds)) == 0;
  ::close(handle);
  if (late) ::kill(-child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (late || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) return "late";
  return std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) return hagfish::run_program(argc, argv);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, '\t');
    const double seconds = std::stod(field);
    std::vector<std::string> arguments{"hagfish"};
    while (std::getline(fields, field, '\t')) arguments.push_back(field);
    const pid_t child = ::fork();
    if (child == 0) run_job(arguments, seconds);
    std::cout << await(child, seconds) << std::endl;
  }
}
