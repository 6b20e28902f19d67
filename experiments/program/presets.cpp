#include "experiments/program/presets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <toml.hpp>

#include "core/input/builtin_files.hpp"
#include "core/input/input_error.hpp"

namespace hagfish {

std::vector<Preset> presets() {
  constexpr const char* file = "presets.toml";
  std::istringstream text{std::string(*builtin_file(file))};
  std::vector<Preset> found;
  for (const toml::value& entry : toml::find<toml::array>(toml::parse(text, file), "preset")) {
    found.push_back({toml::find<std::string>(entry, "name"), toml::find<std::string>(entry, "qp"),
                     toml::find<std::vector<std::string>>(entry, "set")});
  }
  return found;
}

std::string preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) {
    names.push_back(preset.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Preset preset_called(const std::string& name) {
  for (const Preset& preset : presets()) {
    if (preset.name == name) {
      return preset;
    }
  }
  throw InputError(fmt::format("--preset {}: no such preset; there are {}", name, preset_names()));
}

}  // namespace hagfish
