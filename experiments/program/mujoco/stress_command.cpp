#include "experiments/mujoco/stress.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <numbers>

#include "experiments/common/csv.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct StressOptions {
  std::string scene;
  std::string method = "default";  ///< of stress_methods()
  std::string level = "as is";     ///< what the row calls the scene's level
  double step = 0;                 ///< h, s; the scene's where 0
  double cpu_limit = 60;           ///< s
  std::vector<std::string> set;    ///< KEY=VALUE overrides, after the method's
  std::string out;                 ///< CSV to write; standard output where empty
  bool force = false;
};

CsvTable csv_of(const StressOptions& options, double step, const StressResult& result) {
  const StressFigures& seen = result.figures;
  const auto number = [](double value) { return fmt::format("{:.3g}", value); };
  return {{"scene", "level", "method", "h_ms", "outcome", "time_s", "energy_gain", "penetration_cm",
           "path_penetration_cm", "limit_violation_deg", "knot", "cpu_s", "message"},
          {std::filesystem::path(options.scene).stem().string(), options.level, options.method,
           fmt::format("{:g}", 1e3 * step), outcome_name(result.status.outcome),
           fmt::format("{:g}", seen.time), number(seen.energy_gain), number(seen.penetration),
           number(seen.path_penetration), number(seen.limit_violation * 180 / std::numbers::pi),
           seen.knot, number(result.cpu_time), result.status.message}};
}

int run_stress(const StressOptions& options) {
  std::optional<TextFile> out;
  if (!options.out.empty()) out.emplace(options.out, options.force);
  std::vector<std::string> set = stress_overrides(options.method, options.step);
  set.insert(set.end(), options.set.begin(), options.set.end());
  const ResolvedScene resolved = scene_argument(options.scene, set);
  const Model& model = resolved.model;
  const StressResult result = stress(resolved.scene, model, options.method, options.cpu_limit);
  const CsvTable table = csv_of(options, resolved.scene.time.step, result);
  if (out) {
    out->write(csv_text(table));
  } else {
    fmt::print("{}", csv_text(table));
  }
  return exit_code::done;
}

}  // namespace

void add_stress(Program& program) {
  const auto options = std::make_shared<StressOptions>();
  CLI::App* stress_app = program.app.add_subcommand(
      "stress", "run a scene by one method at one step and name the outcome: a CSV row");
  stress_app->add_option("SCENE", options->scene, scene_help)->required();
  stress_app->add_option("--method", options->method, "how the steps are taken")
      ->check(one_of(stress_methods()))
      ->capture_default_str();
  stress_app->add_option("--step", options->step, "time step, s (the scene's)")
      ->check(above_zero());
  stress_app->add_option("--level", options->level, "what the row calls the scene's level")
      ->check([](const std::string& text) {
        return text.size() <= 200 ? "" : "has more than 200 characters";
      })
      ->capture_default_str();
  stress_app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  stress_app->add_option("--cpu-limit", options->cpu_limit, "the run is capped after this, s")
      ->check(above_zero())
      ->capture_default_str();
  stress_app->add_option("--out", options->out, "CSV to write (standard output)");
  stress_app->add_flag("--force", options->force, force_help);
  stress_app->callback([options, &program] { program.code = run_stress(*options); });
}

}  // namespace hagfish
