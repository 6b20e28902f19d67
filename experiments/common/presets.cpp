#include "experiments/common/presets.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <toml.hpp>

#include "core/input/builtin_files.hpp"

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

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) {
    names.push_back(preset.name);
  }
  return names;
}

Preset preset_called(const std::string& name) {
  const std::vector<Preset> known = presets();
  const auto found = std::ranges::find(known, name, &Preset::name);
  if (found == known.end()) {
    throw std::invalid_argument("unknown preset '" + name + "'");
  }
  return *found;
}

}  // namespace hagfish
