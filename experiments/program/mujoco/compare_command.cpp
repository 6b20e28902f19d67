#include "experiments/mujoco/studies.hpp"

#include <optional>

#include "core/log/hdf5/output_file.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct CompareOptions {
  std::string scene = default_scene;
  std::string out;               ///< HDF5 file for the figure; none where empty
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  bool force = false;            ///< replace an existing file
};

int run_compare(const CompareOptions& options, const std::string& typed) {
  const ResolvedScene resolved = scene_argument(options.scene, options.set);
  std::optional<OutputFile> file;
  if (!options.out.empty()) file.emplace(options.out, replaced_if(options.force));
  Hdf5Writer h5;
  const bool passed = compare(resolved, h5);
  if (file) {
    h5.root_attribute("command", typed);
    h5.root_attribute("scene", scene_to_toml(resolved.scene, resolved.specimen));
    h5.save(file->partial());
    file->publish();
  }
  return passed ? exit_code::done : exit_code::failed;
}

}  // namespace

void add_compare(Program& program) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* compare_app = program.app.add_subcommand(
      "compare", "hold the simulator against MuJoCo; exits 1 where a bound is passed");
  compare_app->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  compare_app->add_option("--out", options->out, "HDF5 file to write, for the figure");
  compare_app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  compare_app->add_flag("--force", options->force, "replace an existing file");
  compare_app->callback(
      [options, &program] { program.code = run_compare(*options, program.typed); });
}

}  // namespace hagfish
