#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/control/controller.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "core/log/reading/log_contents.hpp"
#include "core/log/reading/logged_run.hpp"
#include "experiments/export/swept_skin.hpp"
#include "experiments/judge/replay.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct InfoOptions {
  std::vector<std::string> logs;
  bool json = false;
};

/// Where a phase begins.
struct PhaseStart {
  const char* phase = "";
  double time = 0;  ///< s
  std::string knot;
  double head_end = NAN, tail_end = NAN;  ///< of the knot, cm of arc; nan without contacts
};

struct LogInfo {
  std::string file;
  std::vector<std::pair<std::string, std::string>> root;  ///< attributes: status, command, ...
  std::string title;
  int bodies = 0, velocities = 0;
  std::size_t frames = 0, steps = 0;
  double first = 0, last = 0, step = 0, wall_time = 0;  ///< s
  std::vector<PhaseStart> phases;
  std::vector<std::string> warnings;
  double swept = NAN, skin = NAN;  ///< cm^2: what the knot swept, and all; nan without q
};

std::vector<PhaseStart> phase_starts(const LogContents& log) {
  const std::vector<double> head_end = log.h5.doubles("/knot/head_end");
  const std::vector<double> tail_end = log.h5.doubles("/knot/tail_end");
  const std::vector<KnotInvariants> types = logged_knots(log);
  std::vector<PhaseStart> starts;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (f == 0 || log.phase[f] != log.phase[f - 1]) {
      starts.push_back({phase_name(static_cast<Phase>(log.phase[f])), log.time[f],
                        knot_name(types[f]), head_end[f], tail_end[f]});
    }
  }
  return starts;
}

/// Of a log that does not hold each step, those up to its last frame.
std::size_t step_count(const LogContents& log) {
  if (level_of(log.h5) == LogLevel::full) return log.h5.shape("/steps/kkt").at(0);
  const std::vector<std::int64_t> step = log.h5.integers("/trajectory/step");
  return static_cast<std::size_t>(step.back() - step.front());
}

LogInfo read_info(const std::string& file) {
  const LogContents log(file, LogLevel::summary);
  LogInfo info;
  info.file = file;
  for (const char* name : {"status", "created", "command", "creator_version", "git_revision",
                           "libraries", "compiler", "cpu"}) {
    info.root.emplace_back(name, printable(log.h5.root_text(name)));
  }
  info.root.emplace_back("log_level", log_level_name(level_of(log.h5)));
  info.title = printable(log.resolved.scene.title);
  info.bodies = log.model.body_count();
  info.velocities = log.model.nv();
  info.frames = log.time.size();
  info.steps = step_count(log);
  info.first = log.time.front();
  info.last = log.time.back();
  info.step = log.resolved.scene.time.step;
  info.wall_time = log.h5.doubles("/diagnostics/wall_time").back();
  info.phases = phase_starts(log);
  std::istringstream warnings(log.h5.root_text("warnings"));
  for (std::string line; std::getline(warnings, line);) info.warnings.push_back(printable(line));
  if (level_of(log.h5) != LogLevel::summary) {
    const SweptSkin swept = swept_skin(log);
    info.swept = swept.swept();
    info.skin = swept.all();
  }
  return info;
}

void print_info(const LogInfo& info) {
  for (const auto& [name, text] : info.root) {
    fmt::print("{:<16} {}\n", name, text);
  }
  fmt::print("{:<16} {}\n", "scene", info.title);
  fmt::print("{:<16} {} bodies, {} velocities\n", "model", info.bodies, info.velocities);
  fmt::print("{:<16} {} frames, t = {:g} to {:g} s, h = {:g} s, {} steps\n", "frames", info.frames,
             info.first, info.last, info.step, info.steps);
  fmt::print("{:<16} {:.1f} s\n", "wall time", info.wall_time);
  for (const PhaseStart& start : info.phases) {
    fmt::print("{:<16} from {:.2f} s, {}{}\n", start.phase, start.time, knot_words(start.knot),
               std::isnan(start.head_end) ? ""
                                          : fmt::format(", contacts from {:.1f} to {:.1f} cm",
                                                        start.head_end, start.tail_end));
  }
  if (info.swept > 0) {
    fmt::print("{:<16} {:.1f} cm^2 of skin by the knot, {:.1f} % of {:.0f} cm^2\n", "swept",
               info.swept, 100 * info.swept / info.skin, info.skin);
  }
  for (const std::string& warning : info.warnings) fmt::print("{:<16} {}\n", "warning", warning);
}

nlohmann::ordered_json json_of(const LogInfo& info) {
  nlohmann::ordered_json json{{"log", info.file}};
  for (const auto& [name, text] : info.root) json[name] = text;
  json["scene"] = info.title;
  json["bodies"] = info.bodies;
  json["velocities"] = info.velocities;
  json["frames"] = info.frames;
  json["steps"] = info.steps;
  json["first_time_s"] = info.first;
  json["last_time_s"] = info.last;
  json["step_s"] = info.step;
  json["wall_time_s"] = info.wall_time;
  json["swept_cm2"] = info.swept;
  json["skin_cm2"] = info.skin;
  json["warnings"] = info.warnings;
  json["phases"] = nlohmann::ordered_json::array();
  for (const PhaseStart& start : info.phases) {
    // What is no number becomes null.
    json["phases"].push_back({{"phase", start.phase},
                              {"from_s", start.time},
                              {"knot", start.knot},
                              {"head_end_cm", start.head_end},
                              {"tail_end_cm", start.tail_end}});
  }
  return json;
}

int info(const InfoOptions& options) {
  auto json = nlohmann::ordered_json::array();
  for (const std::string& file : options.logs) {
    const LogInfo info = read_info(file);
    if (options.json) {
      json.push_back(json_of(info));
      continue;
    }
    if (options.logs.size() > 1)
      fmt::print("{}{}:\n", &file == options.logs.data() ? "" : "\n", printable(file));
    print_info(info);
  }
  if (options.json)
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  return exit_code::done;
}

}  // namespace

void add_info(Program& program) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* info_app = program.app.add_subcommand("info", "say what logs hold");
  info_app->add_option("LOG", options->logs, "log files")->required();
  info_app->add_flag("--json", options->json, "as JSON: an array, an object a log");
  info_app->callback([options, &program] { program.code = info(*options); });
}

}  // namespace hagfish
