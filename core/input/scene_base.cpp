#include "core/input/scene_parts.hpp"

#include <algorithm>
#include <utility>

#include "core/input/builtin_files.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

SceneSource builtin_base(const TableReader& root, const std::string& base) {
  const std::vector<std::string_view> views = builtin_scene_names();
  const std::vector<std::string> names(views.begin(), views.end());
  if (std::ranges::find(names, base) == names.end()) {
    root.fail("base", "no such built-in scene; did you mean " + nearest(base, names) + "?");
  }
  return {std::string(*builtin_file(base + ".toml")), base + " (built in)", std::nullopt};
}

/// Whether a base is called by the name of a file: one that ends in .toml and is more than that.
bool names_file(const std::string& base) {
  constexpr std::string_view ending = ".toml";
  return base.ends_with(ending) && base.size() > ending.size() &&
         base[base.size() - ending.size() - 1] != '/';
}

/// The source that `base` names, in the scene of `root` and `scene`.
SceneSource find_base(const TableReader& root, const std::string& base, const SceneSource& scene,
                      const FileAccess* access) {
  if (!scene.file || !names_file(base)) return builtin_base(root, base);
  try {
    return access->read(base, scene.file);
  } catch (const InputError& error) {
    root.fail("base", error.what());
  }
}

bool same_source(const SceneSource& a, const SceneSource& b, const FileAccess* access) {
  if (!a.file || !b.file) return !a.file && !b.file && a.name == b.name;
  return access->same(*a.file, *b.file);
}

/// Fails where `base` is among `sources`, each of which is the base of the one before.
void check_circle(const TableReader& root, const SceneSource& base,
                  const std::vector<SceneSource>& sources, const FileAccess* access) {
  auto at =
      std::ranges::find_if(sources, [&](const auto& s) { return same_source(s, base, access); });
  if (at == sources.end()) return;
  if (at + 1 == sources.end()) root.fail("base", "a scene cannot be its own base");
  std::string circle;
  for (; at != sources.end(); ++at) circle += at->name + ", ";
  root.fail("base", "bases form a circle: " + circle + base.name);
}

}  // namespace

TableReader read_with_bases(SceneSource scene, std::vector<SceneSource>& sources,
                            const FileAccess* access) {
  TableReader root(scene.text, scene.name);
  sources.push_back(std::move(scene));
  root.read_units();
  std::string name;
  root.string("base", name);
  if (!root.has("base")) return root;
  SceneSource base = find_base(root, name, sources.back(), access);
  check_circle(root, base, sources, access);
  root.inherit(read_with_bases(std::move(base), sources, access));
  return root;
}

}  // namespace hagfish
