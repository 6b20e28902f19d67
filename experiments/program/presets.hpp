// Settings of a run by name: data/presets.toml.
#pragma once

#include <string>
#include <vector>

namespace hagfish {

struct Preset {
  std::string name;
  std::string qp;                ///< QP back end
  std::vector<std::string> set;  ///< KEY=VALUE overrides of the scene
};

/// All of them, in the file's order.
std::vector<Preset> presets();

/// "quick, default, figure".
std::string preset_names();

/// Throws InputError, whose line names the known ones, where there is none called `name`.
Preset preset_called(const std::string& name);

}  // namespace hagfish
