#include <filesystem>

#include "experiments/common/csv.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"
#include "experiments/program/told_sweep.hpp"
#include "experiments/sweep/sure.hpp"

namespace hagfish {
namespace {

struct SureOptions {
  SweepArguments sweep;
  std::string scene;
  std::vector<std::string> set;
};

int sure(const SureOptions& options, const std::string& typed) {
  const std::vector<SureCase> cases = sure_cases(scene_argument(options.scene, options.set));
  const Grid grid = sure_grid(options.scene, options.set, cases);
  if (!run_told_sweep(grid, {}, options.sweep, typed)) return exit_code::failed;
  CsvTable causes{{"cell", "cause"}};
  for (const SureCase& each : cases) {
    causes.push_back({std::to_string(causes.size() - 1), each.cause});
  }
  const std::filesystem::path folder = options.sweep.out;
  TextFile((folder / "causes.csv").string(), true).write(csv_text(causes));
  const int code = run_script("sure.py", {folder.string()});
  return code == 0 ? exit_code::done : exit_code::bad_input;
}

}  // namespace

void add_sure(Program& program) {
  const auto options = std::make_shared<SureOptions>();
  CLI::App* app = program.app.add_subcommand(
      "sure",
      "how sure a scene's figures are: their spread over meshes, steps, starts and animals");
  app->add_option("SCENE", options->scene, scene_help)->required();
  app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  add_sweep_options(*app, options->sweep);
  app->callback([options, &program] { program.code = sure(*options, program.typed); });
}

}  // namespace hagfish
