// What to say of a command line that names what is not there.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hagfish {

/// One line on a command line that CLI11 rejects, with the command or option that was perhaps
/// meant; a scene or log in the place of a command is told which command takes it.
std::string complaint(const CLI::App& app, const CLI::ParseError& error);

/// Lets an option take one of `names` only.
CLI::Validator one_of(const std::vector<std::string>& names);

}  // namespace hagfish
