#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "core/chain/model.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct MjcfOptions {
  std::string scene = default_scene;
  std::string out;               ///< folder to write to, made where it is missing
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  bool clamp = false;            ///< weld the head to the world
  bool flat = false;             ///< all in one file
  bool force = false;            ///< replace existing files
};

int mjcf(const MjcfOptions& options) {
  const ResolvedScene resolved = scene_argument(options.scene, options.set);
  const Scene& scene = resolved.scene;
  const Model& model = resolved.model;
  auto files = mjcf_files(model, scene.contact.least_arc, scene.time.step,
                          options.clamp ? Head::clamped : Head::free);
  try {
    const MujocoModel loaded(files);
  } catch (const std::runtime_error& error) {
    throw InputError(options.scene + ": MuJoCo rejects the model: " + error.what());
  }
  if (options.flat) files = {{mjcf_root_file, flat_mjcf(files)}};
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw FileError(options.out + ": cannot make the folder: " + error.message());
  }
  for (const auto& [name, text] : files) {
    TextFile(fs::path(options.out) / name, options.force).write(text);
  }
  fmt::print("{}: {} bodies in {} files\n",
             printable((fs::path(options.out) / mjcf_root_file).string()), model.body_count(),
             files.size());
  return exit_code::done;
}

}  // namespace

void add_mjcf(Program& program) {
  const auto options = std::make_shared<MjcfOptions>();
  CLI::App* mjcf_app =
      program.app.add_subcommand("mjcf", "write a scene's animal as MJCF, for MuJoCo");
  mjcf_app->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  mjcf_app->add_option("--out", options->out, "folder to write to")->required();
  mjcf_app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  mjcf_app->add_flag("--clamp", options->clamp, "weld the head to the world");
  mjcf_app->add_flag("--flat", options->flat, "all in one file, without includes");
  mjcf_app->add_flag("--force", options->force, "replace existing files");
  mjcf_app->callback([options, &program] { program.code = mjcf(*options); });
}

}  // namespace hagfish
