#include <fmt/format.h>

#include "core/input/csv/curvature_csv.hpp"
#include "core/input/input_text.hpp"
#include "core/log/reading/log_contents.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/design/program_fit.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct ProgramOptions {
  bool force = false;  ///< replace an existing file
  std::string log, out;
  int stations = 20, times = 24;
  double until = 0;  ///< s; 0: to the end of forming
};

int make_program(const ProgramOptions& options) {
  const LogContents log(options.log, LogLevel::frames);
  const auto taken = [&](std::size_t f) {
    return options.until > 0 ? log.time[f] <= options.until
                             : log.phase[f] == static_cast<int>(Phase::form);
  };
  std::vector<double> time;
  for (std::size_t f = 0; f < log.time.size() && taken(f); ++f) time.push_back(log.time[f]);
  const auto frames = static_cast<Eigen::Index>(time.size());
  if (time.size() < 2 || time[0] != 0) {
    throw FileError(options.log + ": has no phase form that begins at time 0");
  }
  if (options.times > frames || options.stations > log.model.body_count() / 4) {
    throw InputError(fmt::format(
        "{}: {} frames and {} bodies allow at most {} times and {} stations", options.log, frames,
        log.model.body_count(), frames, log.model.body_count() / 4));
  }
  TextFile out(options.out, options.force);
  const ProgramFit fit =
      fit_program(log.model, time, log.q.topRows(frames), options.times, options.stations);
  out.write(curvature_csv(fit.program));
  fmt::print(
      "{}: {} stations x {} times, {:g} s; rms error {:.2g} rad a hinge of {:.2g}, largest "
      "{:.2g}\n",
      printable(options.out), options.stations, options.times, time.back(), fit.rms_error,
      fit.rms_angle, fit.largest_error);
  return exit_code::done;
}

}  // namespace

void add_program(Program& program) {
  const auto options = std::make_shared<ProgramOptions>();
  CLI::App* app = program.app.add_subcommand(
      "program",
      "make a curvature program from the shapes of a log, so that the animal ties itself");
  app->add_option("LOG", options->log, "log of a run from time 0 on")->required();
  app->add_option("--out", options->out, "CSV file to write")->required();
  app->add_option("--stations", options->stations, "along the body")
      ->check(from_to(2, 100))
      ->capture_default_str();
  app->add_option("--times", options->times, "from 0 to the end of forming")
      ->check(from_to(2, 1000))
      ->capture_default_str();
  app->add_option("--until", options->until,
                  "s; where not given, while the knot forms: what follows is the controller's")
      ->check(above_zero());
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = make_program(*options); });
}

}  // namespace hagfish
