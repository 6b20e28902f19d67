#include "experiments/program/own_process.hpp"

#include <H5Cpp.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "core/input/files/text_file.hpp"
#include "core/input/input_text.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

volatile std::sig_atomic_t child = 0;

/// What a terminal sends reaches both processes.
void pass_on(int signal, siginfo_t* from, void* /*context*/) {
  if (from->si_code <= 0) ::kill(child, signal);
}

/// What HDF5 may do on a damaged file, or an empty text.
std::string misfortune(int signal) {
  switch (signal) {
    case SIGVTALRM:
      return "HDF5 comes to no end on it";
    case SIGSEGV:
    case SIGBUS:
    case SIGABRT:
    case SIGFPE:
    case SIGILL:
      return std::string("reading it ended in a crash (") + ::strsignal(signal) + ")";
    default:
      return "";
  }
}

/// The C library says on descriptor 2 that memory was spoilt, before it ends the process. Our own
/// words go to a copy of it, so that these alone are read.
void keep_words() {
#ifndef __SANITIZE_ADDRESS__  // whose reports go there, too
  std::FILE* const words = ::fdopen(::dup(STDERR_FILENO), "w");
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (words == nullptr || nowhere < 0) return;
  std::setvbuf(words, nullptr, _IONBF, 0);
  stderr = words;
  ::dup2(nowhere, STDERR_FILENO);
#endif
}

}  // namespace

std::string hdf5_arguments(int argc, char** argv) {
  H5::Exception::dontPrint();
  std::string files;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (argv[i - 1] == std::string("--out") || !unreadable(name).empty()) continue;
    if (H5Fis_hdf5(name.c_str()) > 0) files += (files.empty() ? "" : ", ") + name;
  }
  return files;
}

int in_own_process(const std::string& files, const std::function<int()>& work) {
  const pid_t parent = ::getpid();
  child = ::fork();
  if (child < 0) return work();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) std::_Exit(exit_code::failed);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    keep_words();
    const int code = work();
    std::fflush(nullptr);
    std::_Exit(code);
  }
  struct sigaction action {};
  action.sa_sigaction = pass_on;
  action.sa_flags = SA_SIGINFO;
  for (const int signal : ending_signals) ::sigaction(signal, &action, nullptr);
  ::sigaction(SIGQUIT, &action, nullptr);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status);
  const int signal = WTERMSIG(status);
  const std::string what = misfortune(signal);
  if (what.empty()) {  // it was sent
    std::signal(signal, SIG_DFL);
    ::raise(signal);
  }
  say("hagfish: {}: {}: the file is damaged, or memory is short\n", printable(files), what);
  return exit_code::bad_input;
}

}  // namespace hagfish
