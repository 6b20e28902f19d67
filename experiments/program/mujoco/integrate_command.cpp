#include "experiments/mujoco/studies.hpp"

#include <algorithm>

#include "core/log/hdf5/output_file.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct IntegrateOptions {
  std::string scene = default_scene;
  std::string motion = "coil";   ///< which start (motions.hpp)
  std::string out;               ///< HDF5 file for the figure
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  bool force = false;            ///< replace an existing file
};

std::vector<std::string> motion_names() {
  std::vector<std::string> names;
  for (const Motion& motion : motions) names.emplace_back(motion.name);
  return names;
}

int run_integrate(const IntegrateOptions& options, const std::string& typed) {
  const ResolvedScene resolved = scene_argument(options.scene, options.set);
  const Motion& motion = *std::ranges::find(motions, options.motion, &Motion::name);
  OutputFile file(options.out, replaced_if(options.force));
  Hdf5Writer h5;
  if (!integrate(resolved, motion, h5)) {
    return exit_code::failed;
  }
  h5.root_attribute("command", typed);
  h5.root_attribute("scene", scene_to_toml(resolved.scene, resolved.specimen));
  h5.save(file.partial());
  file.publish();
  return exit_code::done;
}

}  // namespace

void add_integrate(Program& program) {
  const auto options = std::make_shared<IntegrateOptions>();
  CLI::App* integrate_app = program.app.add_subcommand(
      "integrate", "error against CPU time along a smooth motion, for the core and MuJoCo");
  integrate_app->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  integrate_app->add_option("--motion", options->motion, "the motion")
      ->check(one_of(motion_names()))
      ->capture_default_str();
  integrate_app->add_option("--out", options->out, "HDF5 file to write")->required();
  integrate_app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  integrate_app->add_flag("--force", options->force, "replace an existing file");
  integrate_app->callback(
      [options, &program] { program.code = run_integrate(*options, program.typed); });
}

}  // namespace hagfish
