// hagfish: runs scenes and reads their logs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "core/build_info.hpp"
#include "core/hdf5_error.hpp"
#include "core/input_error.hpp"
#include "experiments/commands.hpp"
#include "solvers/box_qp.hpp"

namespace {

constexpr int bad_input = 2;

std::string joined(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    text += (i > 0 ? " " : "") + std::string(argv[i]);
  }
  return text;
}

int dispatch(int argc, char** argv) {
  CLI::App app{"A hagfish that ties itself into a knot and slides it to its head."};
  app.set_version_flag("--version", hagfish::build_version() + " " + hagfish::build_revision());
  app.require_subcommand(1);
  int code = 0;

  hagfish::RunOptions options;
  options.command = joined(argc, argv);
  CLI::App* run = app.add_subcommand("run", "run a scene and write its log");
  run->add_option("SCENE", options.scene, "a built-in scene (see `scenes`) or a TOML file")
      ->capture_default_str();
  run->add_option("--out", options.out, "log to write (SCENE.h5)");
  run->add_option("--qp", options.qp, "QP back end")
      ->check(CLI::IsMember(hagfish::box_qp_solver_names()))
      ->capture_default_str();
  run->add_option("--set", options.set, "override a scene's key: KEY=VALUE, repeatable")
      ->allow_extra_args(false);
  run->add_flag("--force", options.force, "replace an existing log");
  run->add_flag("--quiet", options.quiet, "no progress");
  run->callback([&] { code = hagfish::run(options); });

  app.add_subcommand("scenes", "list the built-in scenes")->callback([&] {
    code = hagfish::list_scenes();
  });
  std::string file;
  CLI::App* info = app.add_subcommand("info", "say what a log holds");
  info->add_option("LOG", file, "log file")->required();
  info->callback([&] { code = hagfish::info(file); });
  CLI::App* check = app.add_subcommand("check", "audit a log; exits 1 naming what fails");
  check->add_option("LOG", file, "log file")->required();
  check->callback([&] { code = hagfish::check(file); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return app.exit(error);  // help and version
    }
    fmt::print(stderr, "hagfish: {} (see hagfish --help)\n", error.what());
    return bad_input;
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const hagfish::InputError& error) {
    fmt::print(stderr, "hagfish: {}\n", error.what());
  } catch (const hagfish::FileError& error) {
    fmt::print(stderr, "hagfish: {}\n", error.what());
  } catch (const std::exception& error) {
    fmt::print(stderr, "hagfish: unforeseen: {}\n", error.what());
  }
  return bad_input;
}
