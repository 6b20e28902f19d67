// Scene and specimen files: TOML, with every number checked. data/table1.toml shows each key.
//
// Keys are the names of the members of Scene (settings.hpp) and Specimen (specimen.hpp), in the
// same units; angles are given in degrees under NAME_deg, or in rad under NAME_rad. Lengths along
// the body may be shares of it ("0.2 L") or mean diameters ("12 D"). A scene may
// name a base, another scene whose keys it inherits: a built-in scene's name, or a file that ends
// in .toml, relative to the one that names it. Tables merge key by key, arrays replace. Keys absent
// from all of these keep the defaults of settings.hpp; a specimen has no defaults. All functions
// that read throw InputError, whose one line names file, key and reason.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/input/input_error.hpp"
#include "core/scene/settings.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

/// A scene and the animal in it. `scene.specimen` is empty where the scene carries its own; a
/// script of kind none has no knots, whatever the file lists.
struct ResolvedScene {
  Scene scene;
  Specimen specimen;
};

Specimen read_specimen(const std::filesystem::path& file);

/// Reads a scene file. Each override is "KEY=VALUE" with a dotted key ("time.step=0.005") and a
/// TOML value; a string needs no quotes. `specimen.KEY=VALUE` changes the specimen wherever it is
/// read from. A specimen file is looked for beside the file that names it, or, where an override
/// names it, in the working directory.
ResolvedScene read_scene(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides = {});

/// Texts in place of files, by the names that a scene has for them.
using TextFiles = std::map<std::string, std::string>;

/// The same from text; `name` stands for the file in errors. A file that the text names (specimen,
/// script.program, controller.reduced_basis.file) is looked for in `files` and then among the
/// built-in ones (builtin_files.hpp).
ResolvedScene read_scene_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides = {},
                              const TextFiles& files = {});

/// The whole scene, the specimen in it, as text from which read_scene_text() makes the same numbers
/// to the last bit. Throws std::invalid_argument for a number that is not finite.
std::string scene_to_toml(const Scene& scene, const Specimen& specimen);

}  // namespace hagfish
