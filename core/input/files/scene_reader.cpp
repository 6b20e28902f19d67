#include "core/input/files/scene_reader.hpp"

#include <system_error>

#include "core/input/files/text_file.hpp"

namespace hagfish {
namespace {

SceneSource read_beside(const std::string& name, const std::optional<std::string>& from) {
  std::filesystem::path file = name;
  if (from) file = std::filesystem::path(*from).parent_path() / file;
  return {read_text_file(file), file.string(), file.string()};
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

constexpr FileAccess files_of_the_disc{read_beside, same_file};

}  // namespace

Specimen read_specimen(const std::filesystem::path& file) {
  return read_specimen_text(read_text_file(file), file.string());
}

ResolvedScene read_scene(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides) {
  return read_scene_source({read_text_file(file), file.string(), file.string()}, overrides, {},
                           &files_of_the_disc);
}

ResolvedScene read_scene_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides, const TextFiles& files) {
  return read_scene_source({text, name, std::nullopt}, overrides, files, &files_of_the_disc);
}

}  // namespace hagfish
