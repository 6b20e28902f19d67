#include "experiments/program/run_program.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <string>

#include "core/input/input_text.hpp"
#include "core/log/build_info.hpp"
#include "experiments/common/failure.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/program/own_process.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

std::string joined(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    text += (i > 0 ? " " : "") + std::string(argv[i]);
  }
  return text;
}

int dispatch(int argc, char** argv) {
  Program program;
  CLI::App& app = program.app;
  program.typed = joined(argc, argv);
  app.description("A hagfish that ties itself into a knot and slides it to its head.");
  app.set_version_flag("--version", build_version() + " " + build_revision());
  app.require_subcommand(1);
  for (const Registrar add : commands()) add(program);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return app.exit(error);  // help and version
    }
    say("hagfish: {}\n", printable(complaint(app, error)));
    return exit_code::bad_input;
  }
  return program.code;
}

int run_here(int argc, char** argv) {
  try {
    const int code = dispatch(argc, argv);
    if (!standard_output_arrived()) {
      say("hagfish: standard output cannot be written\n");
      return exit_code::failed;
    }
    return code;
  } catch (const std::exception& error) {
    say("hagfish: {}\n", reason(error));
    return is_bad_input(error) ? exit_code::bad_input : exit_code::failed;
  } catch (...) {
    say("hagfish: internal error: an exception of no standard kind\n");
    return exit_code::failed;
  }
}

/// Whether the stack is large enough, or could be made so.
bool stack_suffices() {
  constexpr rlim_t least = 1 << 21;  // bytes: MuJoCo reads the bodies of a chain, 400, in 0.9 MB
  rlimit stack{};
  if (::getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= least) return true;
  stack = {least, std::max(stack.rlim_max, least)};  // scripts have it, too
  return ::setrlimit(RLIMIT_STACK, &stack) == 0;
}

}  // namespace

int run_program(int argc, char** argv) {
  open_standard_streams();
  if (!stack_suffices()) {
    say("hagfish: the stack is too small, and may not grow: 2 MB are needed (ulimit -s 2048)\n");
    return exit_code::failed;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told by its write
  const auto work = [&] { return run_here(argc, argv); };
  const std::string files = hdf5_arguments(argc, argv);
  return files.empty() ? work() : in_own_process(files, work);
}

}  // namespace hagfish
