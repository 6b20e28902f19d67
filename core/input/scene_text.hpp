// Scenes and specimens as text: TOML, with every number checked. data/table1.toml shows each key.
// No file is touched here; scene_reader.hpp reads those.
//
// Keys are the names of the members of Scene (settings.hpp) and Specimen (specimen.hpp), in the
// same units; angles are given in degrees under NAME_deg, or in rad under NAME_rad. Lengths along
// the body may be shares of it ("0.2 L") or mean diameters ("12 D"). A scene may
// name a base, another scene whose keys it inherits: a built-in scene's name, or a file that ends
// in .toml, relative to the one that names it. Tables merge key by key, arrays replace. Keys absent
// from all of these keep the defaults of settings.hpp; a specimen has no defaults. All functions
// that read throw InputError, whose one line names file, key and reason.
#pragma once

#include <exception>
#include <map>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/input_error.hpp"
#include "core/scene/settings.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

/// A scene and the animal in it. `scene.specimen` is empty where the scene carries its own; a
/// script of kind none has no knots, whatever the file lists.
struct ResolvedScene {
  Scene scene;
  Specimen specimen;
  Model model;  ///< the chain that they make (make_hagfish), as they were read
};

/// Texts in place of files, by the names that a scene has for them.
using TextFiles = std::map<std::string, std::string>;

/// A text, before it is read.
struct SceneSource {
  std::string text;
  std::string name;                 ///< name in errors
  std::optional<std::string> file;  ///< the path of its file; nothing for a text of no file
};

/// How files that a scene names are read, where there are files at all.
struct FileAccess {
  /// The file `name`, looked for beside the file `from`, or in the working directory where there is
  /// none. Throws InputError where it cannot be read.
  SceneSource (*read)(const std::string& name, const std::optional<std::string>& from);
  /// Whether two paths, of files that were read a moment ago, are of the same one.
  bool (*same)(const std::string& a, const std::string& b);
};

/// Reads a scene. Each override is "KEY=VALUE" with a dotted key ("time.step=0.005") and a TOML
/// value; a string needs no quotes. `specimen.KEY=VALUE` changes the specimen wherever it is read
/// from. A file that the scene names (specimen, script.program, controller.reduced_basis.file) is
/// looked for in `files`, then by `access`, where the scene is of a file or an override names it,
/// and else among the built-in ones (builtin_files.hpp). Without `access` no file is read.
ResolvedScene read_scene_source(const SceneSource& source,
                                const std::vector<std::string>& overrides = {},
                                const TextFiles& files = {}, const FileAccess* access = nullptr);

/// The specimen in `text`; `name` stands for its file in errors.
Specimen read_specimen_text(const std::string& text, const std::string& name);

/// What `thrown`, which is of `type`, says of bad syntax, as InputError would have it: for programs
/// that do not catch it. Nothing where it is not of the parser's.
std::optional<std::string> toml_fault(const std::exception& thrown, const std::type_info& type);

/// The whole scene, the specimen in it, as text from which read_scene_source() makes the same
/// numbers to the last bit. Throws std::invalid_argument for a number that is not finite.
std::string scene_to_toml(const Scene& scene, const Specimen& specimen);

}  // namespace hagfish
