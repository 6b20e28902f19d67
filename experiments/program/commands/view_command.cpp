#include <fmt/format.h>

#include <filesystem>

#include "core/input/input_text.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"
#include "experiments/view/view_page.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::vector<std::string> logs;  ///< one, or two to compare
  std::string out = "replay.html";
  bool force = false;
};

int view(const ViewOptions& options) {
  TextFile out(options.out, options.force);
  std::vector<nlohmann::ordered_json> logs;
  for (const std::string& file : options.logs) {
    logs.push_back(
        view_data(LogContents(file, LogLevel::frames), fs::path(file).filename().string()));
  }
  const std::string page = view_page(logs);
  out.write(page);
  fmt::print("{}: {:.1f} MB, for any browser\n", printable(options.out),
             1e-6 * static_cast<double>(page.size()));
  return exit_code::done;
}

}  // namespace

void add_view(Program& program) {
  const auto options = std::make_shared<ViewOptions>();
  CLI::App* app = program.app.add_subcommand(
      "view", "write a page that replays one log or two, for a browser without a network");
  app->add_option("LOG", options->logs, "one log, or two to compare")->required()->expected(1, 2);
  app->add_option("--out", options->out, "HTML file to write")->capture_default_str();
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = view(*options); });
}

}  // namespace hagfish
