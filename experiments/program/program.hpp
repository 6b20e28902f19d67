// What the subcommands of `hagfish` share. Each has a file of its own, NAME_command.cpp, in
// commands/, or in mujoco/ where it needs that: its options, its registration, its call.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hagfish {

/// Exit codes of the program.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int failed = 1;      ///< the run, the audit or a QP
inline constexpr int bad_input = 2;   ///< told in one line, and thrown as InputError or FileError
inline constexpr int wrong_knot = 3;  ///< the run ended with a knot that is not the scene's
}  // namespace exit_code

/// The program while its command line is read: CLI11 calls the command that was chosen.
struct Program {
  CLI::App app;
  std::string typed;           ///< the command line, for files that tell how they were made
  int code = exit_code::done;  ///< what the command ended with
};

/// Adds one subcommand to `program`, which outlives its callback.
using Registrar = void (*)(Program& program);

/// Those of all subcommands, in the order of `hagfish --help` (commands.cpp). They are listed by
/// hand: what registers itself by a static object is dropped when it comes from a static library.
std::vector<Registrar> commands();

inline constexpr const char* default_scene = "table1";
inline constexpr const char* scene_help = "a built-in scene (see `scenes`) or a TOML file";
inline constexpr const char* set_help = "override a scene's key: KEY=VALUE, repeatable";

/// One line on a command line that CLI11 rejects, with the command or option that was perhaps
/// meant; a scene or log in the place of a command is told which command takes it.
std::string complaint(const CLI::App& app, const CLI::ParseError& error);

/// Lets an option take one of `names` only.
CLI::Validator one_of(const std::vector<std::string>& names);

/// Lets an option take finite numbers above 0 only: the checks of CLI11 let "nan" pass, and "inf"
/// with some.
CLI::Validator above_zero();

/// Lets an option take finite numbers from `least` to `most` only.
CLI::Validator from_to(double least, double most);

}  // namespace hagfish
