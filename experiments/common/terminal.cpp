#include "experiments/common/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace hagfish {
namespace {

// A signal handler can reach nothing else.
volatile std::sig_atomic_t signalled = 0;
void note(int /*signal*/) { signalled = 1; }

}  // namespace

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      ::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);  // the lowest free number
    }
  }
}

bool standard_output_arrived() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

void note_signals() {
  signalled = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESETHAND;
  for (const int signal : ending_signals) {
    ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return signalled != 0; }

}  // namespace hagfish
