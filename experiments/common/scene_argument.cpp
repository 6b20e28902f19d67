#include "experiments/common/scene_argument.hpp"

#include <algorithm>
#include <filesystem>

#include "core/input/builtin_files.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {

ResolvedScene scene_argument(const std::string& scene, const std::vector<std::string>& overrides) {
  const std::vector<std::string_view> views = builtin_scene_names();
  const std::vector<std::string> names(views.begin(), views.end());
  if (std::find(names.begin(), names.end(), scene) != names.end()) {
    const auto text = builtin_file(scene + ".toml");
    return read_scene_text(std::string(*text), scene + " (built in)", overrides);
  }
  if (std::filesystem::path(scene).extension() != ".toml") {
    throw InputError(scene + ": no built-in scene of that name (see `hagfish scenes`)" +
                     did_you_mean(scene, names));
  }
  return read_scene(scene, overrides);
}

}  // namespace hagfish
