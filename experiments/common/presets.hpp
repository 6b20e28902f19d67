// Settings of a run by name: data/presets.toml.
#pragma once

#include <string>
#include <vector>

namespace hagfish {

struct Preset {
  std::string name;
  std::string qp = "active-set";  ///< QP back end
  std::vector<std::string> set;   ///< KEY=VALUE overrides of the scene
};

/// All of them, in the file's order.
std::vector<Preset> presets();

/// quick, figure.
std::vector<std::string> preset_names();

/// Throws std::invalid_argument where `name` is none of preset_names().
Preset preset_called(const std::string& name);

}  // namespace hagfish
