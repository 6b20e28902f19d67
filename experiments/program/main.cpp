// hagfish: runs scenes and reads their logs.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "core/input/input_text.hpp"
#include "core/log/build_info.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/failure.hpp"
#include "experiments/program/suggestion.hpp"
#include "experiments/program/terminal.hpp"

namespace {

std::string joined(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    text += (i > 0 ? " " : "") + std::string(argv[i]);
  }
  return text;
}

int dispatch(int argc, char** argv) {
  hagfish::Program program;
  CLI::App& app = program.app;
  program.typed = joined(argc, argv);
  app.description("A hagfish that ties itself into a knot and slides it to its head.");
  app.set_version_flag("--version", hagfish::build_version() + " " + hagfish::build_revision());
  app.require_subcommand(1);
  for (const auto& list : {hagfish::commands(), hagfish::mujoco_commands()}) {
    for (const hagfish::Registrar add : list) add(program);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return app.exit(error);  // help and version
    }
    hagfish::say("hagfish: {}\n", hagfish::printable(hagfish::complaint(app, error)));
    return hagfish::exit_code::bad_input;
  }
  return program.code;
}

}  // namespace

int main(int argc, char** argv) {
  using hagfish::say;
  hagfish::open_standard_streams();
  try {
    const int code = dispatch(argc, argv);
    if (!hagfish::standard_output_arrived()) {
      say("hagfish: standard output cannot be written\n");
      return hagfish::exit_code::failed;
    }
    return code;
  } catch (const std::exception& error) {
    say("hagfish: {}\n", hagfish::reason(error));
    return hagfish::is_bad_input(error) ? hagfish::exit_code::bad_input
                                        : hagfish::exit_code::failed;
  } catch (...) {
    say("hagfish: internal error: an exception of no standard kind\n");
    return hagfish::exit_code::failed;
  }
}
