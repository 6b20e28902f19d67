#include <fmt/format.h>

#include "core/input/builtin_files.hpp"
#include "core/input/files/scene_reader.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

void list_scenes() {
  for (const std::string_view name : builtin_scene_names()) {
    const auto text = builtin_file(fmt::format("{}.toml", name));
    const ResolvedScene resolved =
        read_scene_text(std::string(*text), std::string(name) + " (built in)");
    fmt::print("{:<20} {}\n", name, resolved.scene.title);
  }
}

}  // namespace

void add_scenes(Program& program) {
  program.app.add_subcommand("scenes", "list the built-in scenes")->callback(list_scenes);
}

}  // namespace hagfish
