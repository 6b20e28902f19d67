#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/input/csv/delimited_text.hpp"
#include "core/input/files/text_file.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "core/log/reading/log_contents.hpp"
#include "core/log/reading/logged_run.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/judge/replay.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"

namespace hagfish {
namespace {

struct FiguresOptions {
  std::string log;
  std::string out;  ///< folder; LOG_figures where empty
};

/// Since when the knot has been there that is held from frame `held` on, s.
double tied_since(const LogContents& log, std::size_t held) {
  const std::vector<KnotInvariants> types = logged_knots(log);
  std::size_t f = held;
  while (f > 0 && types[f - 1] == types[held]) --f;
  return log.time[f];
}

/// Largest moment of the animal's own torques and f_thigmo together at a joint, mean from a frame
/// to the next, up to the slide or from it on; N cm, nan where there is none.
double largest_moment(const LogContents& log, bool sliding) {
  if (!log.h5.has("/mean/moments/active")) return NAN;
  const Hdf5Reader::Rows moments =
      log.h5.rows("/mean/moments/active") + log.h5.rows("/mean/moments/thigmotaxis");
  double largest = NAN;
  for (Eigen::Index f = 1; f < moments.rows(); ++f) {
    const auto phase = static_cast<Phase>(log.phase[static_cast<std::size_t>(f - 1)]);
    if (phase_order(phase) >= phase_order(Phase::release)) continue;
    if ((phase_order(phase) >= phase_order(Phase::slide)) != sliding) continue;
    for (Eigen::Index at = 0; at < moments.cols(); at += 3) {
      largest = std::fmax(largest, moments.row(f).segment<3>(at).norm());
    }
  }
  return 1e-5 * largest;
}

/// The findings of a table of `hagfish check`; of what a log of frames tells where there is none.
std::vector<Finding> findings_of(const std::string& check_csv, const Judge& judge) {
  if (!std::filesystem::exists(check_csv)) return judge.findings();
  const DelimitedText table(read_text_file(check_csv));
  std::vector<Finding> findings;
  for (std::size_t row = 1; row < table.rows(); ++row) {
    Finding& finding = findings.emplace_back();
    finding.name = table.cell(row, 1);
    finding.passed = table.cell(row, 5) == "yes";
  }
  return findings;
}

/// Whether to trust the run, and what says so.
std::string trust(const LogContents& log, const std::vector<Finding>& findings) {
  std::vector<std::string> unmet;
  for (const Finding& finding : findings) {
    const bool told = !unmet.empty() && unmet.back() == finding.name;
    if (!finding.passed && !told) unmet.push_back(finding.name);
  }
  const std::string text = log.h5.root_text("warnings");
  const auto warnings = text.empty() ? 0 : std::ranges::count(text, '\n') + 1;
  return fmt::format(
      "{}{}{}",
      unmet.empty()
          ? fmt::format("yes, it meets all {} checks", findings.size())
          : fmt::format("no, not before you know why it fails: {}", fmt::join(unmet, ", ")),
      level_of(log.h5) == LogLevel::full ? "" : "; not all can be made of a log of frames",
      warnings > 0 ? fmt::format("; {} warnings are in `hagfish info`", warnings) : "");
}

/// The run for who knows animals and no equations: a title, and ten lines at most.
std::vector<std::string> in_words(const LogContents& log, const std::string& check_csv) {
  const Judge judge = judged_log(log);
  const RunSummary run = judge.summary("", "");
  const Specimen& animal = log.resolved.specimen;
  const Scene& scene = log.resolved.scene;
  std::vector<std::string> lines{printable(scene.title),
                                 fmt::format("animal: {}, {:.4g} cm, {:.4g} g",
                                             printable(animal.name), animal.length, animal.mass),
                                 "knot: " + knot_words(run.knot)};
  const auto held = std::ranges::find_if(
      log.phase, [](std::int64_t phase) { return holds_knot(static_cast<Phase>(phase)); });
  if (held == log.phase.end()) {
    lines.emplace_back("tied: no knot is held in this log");
  } else {
    const auto first = static_cast<std::size_t>(held - log.phase.begin());
    lines.push_back(fmt::format("tied: at {:.2f} s, and held from {:.2f} s on",
                                tied_since(log, first), log.time[first]));
  }
  if (!std::isnan(run.slide_from)) {
    lines.push_back(fmt::format(
        "slide: from {:.2f} s its head end comes {:.1f} cm headward, its tail end {:.1f} cm: it {}",
        run.slide_from, run.slide_distance, run.tail_distance, run.slide));
  }
  lines.push_back(std::isnan(run.free_from) ? "off: the knot is not off where the log ends"
                                            : fmt::format("off: at {:.2f} s", run.free_from));
  if (log.h5.has("/pull/force")) {
    double largest = NAN;
    for (const double force : log.h5.doubles("/pull/force")) largest = std::fmax(largest, force);
    if (!std::isnan(largest))
      lines.push_back(fmt::format("largest pull: {:.3g} N", 1e-5 * largest));
  }
  std::vector<std::string> torques;
  for (const bool sliding : {false, true}) {
    const double largest = largest_moment(log, sliding);
    if (std::isnan(largest)) continue;
    torques.push_back(fmt::format("{:.3g} N cm {}", largest, sliding ? "sliding" : "tying"));
  }
  if (!torques.empty()) {
    lines.push_back(fmt::format("torques of a joint: up to {}", fmt::join(torques, ", ")));
    const bool own =
        scene.model.passive == PassiveSource::specimen && !animal.bending_stiffness.empty();
    lines.push_back(fmt::format(
        "torques grow with the body's rigidity EI: here {:g} N cm^2, of hagfish 0.3 to 12 are "
        "known",
        1e-5 * (own ? animal.bending_stiffness.front() : scene.model.bending_stiffness)));
  }
  lines.push_back("trust it: " + trust(log, findings_of(check_csv, judge)));
  return lines;
}

int figures(const FiguresOptions& options) {
  const LogContents log(options.log,
                        LogLevel::frames);  // what is wrong with it is said here, in one line
  const std::filesystem::path file = options.log;
  const std::string out = options.out.empty()
                              ? (file.parent_path() / (file.stem().string() + "_figures")).string()
                              : options.out;
  const int code = run_script("of_log.py", {options.log, own_program().string(), out});
  if (code == 0) {
    const std::vector<std::string> words = in_words(log, out + "/check.csv");
    const std::string report = out + "/report.md";
    const bool strip = std::filesystem::exists(out + "/figure7.png");
    TextFile(report, true)
        .write(fmt::format("# {}\n\n{}- {}\n", words.front(),
                           strip ? "![The run](figure7.png)\n\n" : "",
                           fmt::join(words.begin() + 1, words.end(), "\n- ")));
    fmt::print("{}\n\n{}\n", printable(report), fmt::join(words, "\n"));
  }
  return code == exit_code::failed || code == 0 ? code : exit_code::bad_input;
}

}  // namespace

void add_figures(Program& program) {
  const auto options = std::make_shared<FiguresOptions>();
  CLI::App* app = program.app.add_subcommand("figures",
                                             "tell a run in ten lines, and draw all figures of its "
                                             "log: pictures, overview, claims, summary");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("--out", options->out, "folder to write to (LOG_figures)");
  app->callback([options, &program] { program.code = figures(*options); });
}

}  // namespace hagfish
