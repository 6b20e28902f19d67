#include <filesystem>

#include "core/log/reading/log_contents.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"

namespace hagfish {
namespace {

struct FiguresOptions {
  std::string log;
  std::string out;  ///< folder; LOG_figures where empty
};

int figures(const FiguresOptions& options) {
  const LogContents log(options.log,
                        LogLevel::frames);  // what is wrong with it is said here, in one line
  const std::filesystem::path file = options.log;
  const std::string out = options.out.empty()
                              ? (file.parent_path() / (file.stem().string() + "_figures")).string()
                              : options.out;
  const int code = run_script("of_log.py", {options.log, own_program().string(), out});
  return code == exit_code::failed || code == 0 ? code : exit_code::bad_input;
}

}  // namespace

void add_figures(Program& program) {
  const auto options = std::make_shared<FiguresOptions>();
  CLI::App* app = program.app.add_subcommand(
      "figures", "draw all figures of a log: overview, Figures 7 and 8, claims, summary");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("--out", options->out, "folder to write to (LOG_figures)");
  app->callback([options, &program] { program.code = figures(*options); });
}

}  // namespace hagfish
