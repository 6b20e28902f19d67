#include "experiments/program/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "core/input/builtin_files.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

std::string help_of(const CLI::App& command) {
  const bool whole = command.get_parent() == nullptr;
  return fmt::format(" (see `hagfish {}--help`)", whole ? "" : command.get_name() + " ");
}

/// Of a word in the place of a command.
std::string no_command(const CLI::App& app, const std::string& word) {
  const auto meant = [&word](const std::string& command) {
    return fmt::format("{}: no such command; did you mean `{}`?", word, command);
  };
  const std::filesystem::path file = word;
  if (file.extension() == ".toml") return meant("run " + word);
  if (file.extension() == ".h5") return meant("check " + word);
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const auto commands = static_cast<std::ptrdiff_t>(names.size());
  for (const std::string_view scene : builtin_scene_names()) names.emplace_back(scene);
  const std::string near = similar(word, names);
  if (near.empty()) return word + ": no such command" + help_of(app);
  const bool scene = std::find(names.begin(), names.end(), near) - names.begin() >= commands;
  return meant((scene ? "run " : "") + near);
}

/// Of an option that `command` does not have.
std::string no_option(const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return word + ": no such option" + did_you_mean(word, names);
}

}  // namespace

std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> left = app.remaining(true);
  const bool option = !left.empty() && left.front().starts_with("--");
  if (chosen.empty() && !left.empty() && !left.front().starts_with('-')) {
    return no_command(app, left.front());
  }
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  return (option ? no_option(command, left.front()) : std::string(error.what())) + help_of(command);
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  const auto reject = [names](const std::string& word) {
    return std::find(names.begin(), names.end(), word) != names.end()
               ? std::string()
               : fmt::format("{} is not one of {}{}", word, fmt::join(names, ", "),
                             did_you_mean(word, names));
  };
  return CLI::Validator(reject, fmt::format("{{{}}}", fmt::join(names, ",")));
}

CLI::Validator above_zero() {
  const auto reject = [](const std::string& word) {
    const std::optional<double> number = finite_number(word);
    return number && *number > 0 ? std::string()
                                 : shortened(word) + " is not a finite number above 0";
  };
  return CLI::Validator(reject, "ABOVE 0");
}

CLI::Validator from_to(double least, double most) {
  const auto reject = [least, most](const std::string& word) {
    const std::optional<double> number = finite_number(word);
    return number && *number >= least && *number <= most
               ? std::string()
               : fmt::format("{} is not a number from {:g} to {:g}", shortened(word), least, most);
  };
  return CLI::Validator(reject, fmt::format("FROM {:g} TO {:g}", least, most));
}

}  // namespace hagfish
